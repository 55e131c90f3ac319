#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/magnetic/field_map_builder.hpp"

#include "contaminated_noise.hpp"
#include "hand_made_survey.hpp"
#include "test_support.hpp"
#include "tiling.hpp"

namespace mstsl {
namespace {

TEST(NoiseWeight, FallsFromOneToAHundredth) {
  EXPECT_GT(noise_weight(0.0, 3), 0.9999);
  EXPECT_GT(noise_weight(11.3, 3), 0.99);  // exceeded by one good fingerprint in a hundred
  EXPECT_NEAR(noise_weight(23.2, 3), 0.5, 0.02);
  EXPECT_NEAR(noise_weight(1e9, 3), 0.01, 1e-6);
  for (double squared = 0.0; squared < 60.0; squared += 1.0)
    EXPECT_GE(noise_weight(squared, 3), noise_weight(squared + 1.0, 3));
}

struct Trolley {
  double first_x_m = 2.0, last_x_m = 4.0, y_m = 2.0;
  Eigen::Vector3d field_uT = {5.0, -4.0, 6.0};
};

/// A survey in which something magnetic moved along with one pass of one lane.
std::vector<Fingerprint> with_trolley(const test::WavyField& field, const Trolley& trolley, Random& random) {
  test::SurveyPlan plan;
  plan.lane_m = 0.4;
  plan.wander_m = 0.03;
  std::vector<Fingerprint> survey = test::drive(field, plan, random);
  for (Fingerprint& f : survey)
    if (std::abs(f.position_m.y() - trolley.y_m) < 0.15 && f.heading_rad == 0.0 &&
        f.position_m.x() > trolley.first_x_m && f.position_m.x() < trolley.last_x_m)
      f.field_uT += trolley.field_uT;
  return survey;
}

double rms_error_at(const FieldMap& map, const test::WavyField& field, const Trolley& trolley) {
  double sum = 0.0;
  int count = 0;
  for (double x = trolley.first_x_m; x <= trolley.last_x_m; x += 0.1)
    for (const double beside_m : {-0.2, 0.0, 0.2}) {
      const Eigen::Vector2d p(x, trolley.y_m + beside_m);
      sum += (map.at(p)->mean_uT - field.at(p)).squaredNorm();
      ++count;
    }
  return std::sqrt(sum / (3 * count));
}

TEST(HeavyTails, APassWithATrolleyIsTrustedLess) {
  Random random(21);
  const test::WavyField field(0.9, 7.0, random);
  const Trolley trolley;
  const auto survey = with_trolley(field, trolley, random);
  FieldMapOptions options;
  options.resolution_m = 0.1;
  options.reach_m = 1.0;
  options.analysis.kernel = KernelChoice::kSquaredExponential;
  const FieldMap heavy = test::must(build_field_map(survey, nullptr, options));
  options.heavy_tails = false;
  const FieldMap gaussian = test::must(build_field_map(survey, nullptr, options));
  EXPECT_GT(heavy.hyperparameters.at("distrusted_fingerprints"), 20.0);
  EXPECT_LT(heavy.hyperparameters.at("distrusted_fingerprints"), 60.0);
  EXPECT_LT(rms_error_at(heavy, field, trolley), 0.35 * rms_error_at(gaussian, field, trolley));
}

TEST(HeavyTails, AGoodSurveyKeepsItsMap) {
  Random random(22);
  const test::WavyField field(0.9, 7.0, random);
  const auto survey = test::drive(field, {}, random);
  FieldMapOptions options;
  options.resolution_m = 0.2;
  const FieldMap heavy = test::must(build_field_map(survey, nullptr, options));
  options.heavy_tails = false;
  const FieldMap gaussian = test::must(build_field_map(survey, nullptr, options));
  EXPECT_LE(heavy.hyperparameters.at("distrusted_fingerprints"), 2.0);
  for (std::size_t i = 0; i < heavy.mean_uT.size(); ++i)
    if (heavy.has_value(heavy.geometry.cell(i)))
      ASSERT_LT((heavy.mean_uT[i] - gaussian.mean_uT[i]).norm(), 0.2F) << i;
}

}  // namespace
}  // namespace mstsl
