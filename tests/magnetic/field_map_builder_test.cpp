#include "mstsl/magnetic/field_map_builder.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/magnetic/gaussian_process.hpp"

#include "hand_made_survey.hpp"
#include "test_support.hpp"

namespace mstsl {
namespace {

using test::drive;
using test::must;
using test::SurveyPlan;
using test::WavyField;

FieldMapOptions coarse() {
  FieldMapOptions options;
  options.resolution_m = 0.2;
  options.reach_m = 1.0;
  return options;
}

double distance_to(const std::vector<Fingerprint>& survey, const Eigen::Vector2d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Fingerprint& f : survey) nearest = std::min(nearest, (f.position_m - p).norm());
  return nearest;
}

/// Of a reading where the map is sure and the field of usual strength.
double reading_uT2(const FieldMap& map, const std::string& axis) {
  return std::pow(map.hyperparameters.at("reading_even_sd_" + axis + "_uT"), 2) +
         std::pow(map.hyperparameters.at("reading_uneven_sd_" + axis + "_uT"), 2);
}

/// By how much the strongest field that is distinguished raises the prior's variance.
double strongest(const std::map<std::string, double>& hyperparameters, const std::string& axis) {
  return std::pow(1e3, hyperparameters.at("strength_power_" + axis));
}

/// What holds for every map of any survey: values are finite or absent, variances positive and no larger than
/// the prior's where the field is no stronger than usual, support means a fingerprint within a length scale.
void expect_sane(const FieldMap& map, const std::vector<Fingerprint>& survey) {
  const auto& h = map.hyperparameters;
  const double length_m = h.at("length_scale_x_m");
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    const Cell cell = map.geometry.cell(i);
    if (!map.has_value(cell)) {
      EXPECT_EQ(map.supported[i], 0);
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      const std::string axis(1, "xyz"[c]);
      const double prior_uT2 = std::pow(h.at("signal_sd_" + axis + "_uT"), 2) + reading_uT2(map, axis);
      EXPECT_TRUE(std::isfinite(map.mean_uT[i](c)));
      EXPECT_GT(map.variance_uT2[i](c), 0.0F);
      EXPECT_LE(map.variance_uT2[i](c), 1.0001 * prior_uT2 * strongest(h, axis));
    }
    const double distance_m = distance_to(survey, map.geometry.center_of(cell));
    const double diagonal_m = std::sqrt(2.0) * map.geometry.resolution_m;
    if (distance_m < length_m - diagonal_m) EXPECT_EQ(map.supported[i], 1);
    if (distance_m > length_m + diagonal_m) EXPECT_EQ(map.supported[i], 0);
  }
}

struct Case {
  const char* name;
  double length_scale_m;
  SurveyPlan plan;
  std::function<void(std::vector<Fingerprint>&)> spoil = [](auto&) {};
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class AnySurvey : public ::testing::TestWithParam<Case> {};

TEST_P(AnySurvey, MakesASaneMap) {
  const Case& c = GetParam();
  Random random(11);
  const WavyField field(c.length_scale_m, 7.0, random);
  std::vector<Fingerprint> survey = drive(field, c.plan, random);
  c.spoil(survey);
  const SurveyAnalysis analysis = must(analyse_survey(survey, FieldModel::kGpr));
  for (const auto quality : {RegressionQuality::kFast, RegressionQuality::kExact}) {
    FieldMapOptions options = coarse();
    options.quality = quality;
    expect_sane(must(build_field_map(analysis, nullptr, options)), survey);
  }
}

void double_every_one(std::vector<Fingerprint>& survey) {
  const std::vector<Fingerprint> once = survey;
  survey.insert(survey.end(), once.begin(), once.end());
}

void stand_still(std::vector<Fingerprint>& survey) { survey.insert(survey.begin() + 40, 3000, survey[40]); }

void leave_a_gap(std::vector<Fingerprint>& survey) {
  std::erase_if(survey,
                [](const Fingerprint& f) { return f.position_m.x() > 2.0 && f.position_m.x() < 5.0; });
}

void spoil_one(std::vector<Fingerprint>& survey) { survey[survey.size() / 2].field_uT.y() += 1000.0; }

void first_hundred(std::vector<Fingerprint>& survey) { survey.resize(100); }

std::string name_of(const ::testing::TestParamInfo<Case>& info) { return info.param.name; }

// clang-format off
INSTANTIATE_TEST_SUITE_P(Surveys, AnySurvey, ::testing::Values(
    Case{"LengthScaleOf20cm", 0.2, {3.0, 2.0, 0.3}},
    Case{"LengthScaleOf45cm", 0.45, {}},
    Case{"LengthScaleOf3m", 3.0, {12.0, 8.0, 1.0}},
    Case{"DenseLanes", 0.6, {4.0, 3.0, 0.3}},
    Case{"LanesTwoMetresApart", 0.6, {8.0, 8.0, 2.0}},
    Case{"OneLane", 0.6, {10.0, 0.0}},
    Case{"LittleNoise", 0.6, {.noise_uT = 0.01}},
    Case{"AHundredTimesTheNoise", 0.6, {.noise_uT = 1.0}},
    Case{"NoiseAsLargeAsTheField", 0.6, {.noise_uT = 7.0}},
    Case{"EachTwice", 0.6, {}, double_every_one},
    Case{"StandingStill", 0.6, {}, stand_still},
    Case{"WithAGap", 0.6, {9.0, 3.0, 0.5}, leave_a_gap},
    Case{"OneWildReading", 0.6, {}, spoil_one},
    Case{"AHundredFingerprints", 0.6, {}, first_hundred}), name_of);
// clang-format on

TEST(BuildFieldMap, AWildReadingLeavesNoTrace) {
  Random random(3);
  const WavyField field(0.6, 7.0, random);
  std::vector<Fingerprint> survey = drive(field, {}, random);
  std::vector<Fingerprint> without = survey;
  const std::size_t wild = survey.size() / 3;
  survey[wild].field_uT.x() -= 1000.0;
  without.erase(without.begin() + static_cast<std::ptrdiff_t>(wild));
  const FieldMap a = must(build_field_map(survey, nullptr, coarse()));
  const FieldMap b = must(build_field_map(without, nullptr, coarse()));
  for (std::size_t i = 0; i < a.mean_uT.size(); ++i)
    if (a.has_value(a.geometry.cell(i))) EXPECT_EQ(a.mean_uT[i], b.mean_uT[i]);
}

FieldHyperparameters given() {
  return {{18.0, 3.0, -42.0}, {6.0, 7.0, 8.0}, Eigen::Array3d::Constant(0.5), {0.48, 0.56, 0.64}};
}
constexpr double kNoiseRatio = 0.08;

/// The regression of all fingerprints at once, in units of the signal.
auto dense_solution(const std::vector<Fingerprint>& survey, const FieldHyperparameters& h) {
  std::vector<Eigen::Vector2d> points;
  Eigen::MatrixXd values(static_cast<Eigen::Index>(survey.size()), 3);
  for (std::size_t i = 0; i < survey.size(); ++i) {
    points.push_back(survey[i].position_m);
    values.row(static_cast<Eigen::Index>(i)) =
        ((survey[i].field_uT.array() - h.mean_uT) / h.signal_sd_uT).transpose();
  }
  const auto kernel = SquaredExponential{1.0, h.length_scale_m(0)} + WhiteNoise{kNoiseRatio};
  return must(fit_exactly(kernel, points, values, false));
}

struct RmsError {
  double supported_in_noises = 0.0;  ///< of cells with a fingerprint within a length scale
  double anywhere_in_sds = 0.0;      ///< of all cells, each by the standard deviation of a reading there
  double variance_max = 0.0;         ///< relative
};

template <typename Exact>
RmsError compare(const FieldMap& map, const Exact& exact, const FieldHyperparameters& h) {
  RmsError error;
  std::size_t all = 0, supported = 0;
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    if (!map.has_value(map.geometry.cell(i))) continue;
    const std::vector<Eigen::Vector2d> center{map.geometry.center_of(map.geometry.cell(i))};
    const auto wanted = exact.predict(center);
    const double variance = wanted.variance(0) + kNoiseRatio * kNoiseRatio;
    ++all;
    supported += map.supported[i];
    for (int c = 0; c < 3; ++c) {
      const double off = (map.mean_uT[i](c) - h.mean_uT(c)) / h.signal_sd_uT(c) - wanted.mean(0, c);
      error.anywhere_in_sds += off * off / variance / 3.0;
      if (map.supported[i] != 0) error.supported_in_noises += off * off / (kNoiseRatio * kNoiseRatio) / 3.0;
      const double relative = map.variance_uT2[i](c) / (std::pow(h.signal_sd_uT(c), 2) * variance) - 1.0;
      error.variance_max = std::max(error.variance_max, std::abs(relative));
    }
  }
  error.anywhere_in_sds = std::sqrt(error.anywhere_in_sds / static_cast<double>(all));
  error.supported_in_noises = std::sqrt(error.supported_in_noises / static_cast<double>(supported));
  return error;
}

TEST(BuildFieldMap, AgreesWithTheDenseSolution) {
  Random random(5);
  const WavyField field(0.5, 7.0, random);
  const std::vector<Fingerprint> survey = drive(field, {4.0, 3.0, 0.5, 0.1, 0.5}, random);
  FieldMapOptions options = coarse();
  options.analysis.bias_removal = BiasRemoval::kNever;
  options.analysis.calibrate_variance = false;
  options.analysis.hyperparameters = given();
  const auto exact = dense_solution(survey, given());
  for (const bool is_exact : {false, true}) {
    options.quality = is_exact ? RegressionQuality::kExact : RegressionQuality::kFast;
    const RmsError e = compare(must(build_field_map(survey, nullptr, options)), exact, given());
    EXPECT_LT(e.supported_in_noises, is_exact ? 0.01 : 0.04);
    EXPECT_LT(e.anywhere_in_sds, is_exact ? 0.01 : 0.04);
    EXPECT_LT(e.variance_max, 0.01);
  }
}

TEST(BuildFieldMap, ReturnsToThePriorFarFromData) {
  Random random(6);
  const WavyField field(0.5, 7.0, random);
  FieldMapOptions options = coarse();
  options.reach_m = 5.0;
  const std::vector<Fingerprint> survey = drive(field, {3.0, 2.0, 0.5}, random);
  const FieldMap map = must(build_field_map(survey, nullptr, options));
  const double far_m = 6.0 * map.hyperparameters.at("length_scale_x_m");
  const double prior_uT2 = std::pow(map.hyperparameters.at("signal_sd_x_uT"), 2) + reading_uT2(map, "x");
  int seen = 0;
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    const Cell cell = map.geometry.cell(i);
    if (!map.has_value(cell) || distance_to(survey, map.geometry.center_of(cell)) < far_m) continue;
    ++seen;
    EXPECT_NEAR(map.variance_uT2[i].x() / prior_uT2, 1.0, 1e-3);
    EXPECT_NEAR(map.mean_uT[i].x(), map.hyperparameters.at("mean_x_uT"), 0.01);
  }
  EXPECT_GT(seen, 50);
}

TEST(BuildFieldMap, IsTheSameAtAnyNumberOfThreads) {
  Random random(7);
  const WavyField field(0.5, 7.0, random);
  const std::vector<Fingerprint> survey = drive(field, {}, random);
  for (const FieldModel model : {FieldModel::kGpr, FieldModel::kBilinear, FieldModel::kFingerprint}) {
    FieldMapOptions options = coarse();
    options.model = model;
    options.threads = Threads{1};
    const FieldMap one = must(build_field_map(survey, nullptr, options));
    options.threads = Threads{5};
    const FieldMap five = must(build_field_map(survey, nullptr, options));
    ASSERT_EQ(one.mean_uT.size(), five.mean_uT.size());
    for (std::size_t i = 0; i < one.mean_uT.size(); ++i)
      if (one.has_value(one.geometry.cell(i))) {
        EXPECT_EQ(one.mean_uT[i], five.mean_uT[i]);
        EXPECT_EQ(one.variance_uT2[i], five.variance_uT2[i]);
      }
  }
}

TEST(BuildFieldMap, ValuesEveryFreeCellOfAnOccupancyGrid) {
  Random random(8);
  const WavyField field(0.5, 7.0, random);
  GridGeometry geometry;
  geometry.resolution_m = 0.1;
  geometry.columns = geometry.rows = 120;
  geometry.map_T_grid = Pose2{-2.0, -3.0, 0.3};
  OccupancyGrid grid(geometry, CellState::kUnknown);
  for (int row = 20; row < 100; ++row)
    for (int column = 20; column < 100; ++column) grid[{column, row}] = CellState::kFree;
  const FieldMap map = must(build_field_map(drive(field, {3.0, 2.0, 0.5}, random), &grid, coarse()));
  EXPECT_NEAR(map.geometry.map_T_grid.yaw, 0.3, 1e-12);
  for (int row = 20; row < 100; ++row)
    for (int column = 20; column < 100; ++column)
      EXPECT_TRUE(map.has_value(map.geometry.cell_at(geometry.center_of({column, row}))));
}

std::string refusal_of(const std::vector<Fingerprint>& survey, const FieldMapOptions& options = {}) {
  const auto map = build_field_map(survey, nullptr, options);
  return map ? "a map" : map.error().message();
}

TEST(BuildFieldMap, RefusesWhatIsNoSurvey) {
  Random random(9);
  const WavyField field(0.5, 7.0, random);
  const std::vector<Fingerprint> good = drive(field, {2.0, 1.0, 0.5}, random);
  EXPECT_NE(refusal_of({}).find("no fingerprint"), std::string::npos);
  EXPECT_NE(refusal_of({good.begin(), good.begin() + 19}).find("19 fingerprints are too few"),
            std::string::npos);
  std::vector<Fingerprint> bad = good;
  bad[7].field_uT.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal_of(bad).find("fingerprint 7"), std::string::npos);
  FieldMapOptions options;
  options.analysis.hyperparameters = FieldHyperparameters{};
  options.analysis.hyperparameters->length_scale_m(1) = -1.0;
  EXPECT_NE(refusal_of(good, options).find("hyper-parameters"), std::string::npos);
}

}  // namespace
}  // namespace mstsl
