#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/magnetic/field_check.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"

#include "hand_made_survey.hpp"
#include "pole_sheets.hpp"
#include "test_support.hpp"

namespace mstsl {
namespace {

constexpr double kSignal_uT = 8.0, kNoise_uT = 0.3;

/// Lanes `lane_m` apart over 8 x 6 m, driven both ways, over poles below.
std::vector<Fingerprint> survey_over_poles(const test::PoleSheets& sheets, double first_m, double lane_m,
                                           Random& random) {
  std::vector<Fingerprint> survey;
  const auto read = [&](double x, double y, double heading_rad) {
    Fingerprint f{
        {x, y}, kSignal_uT * sheets.at({x, y}).matrix() + Eigen::Vector3d(18, 3, -42), heading_rad, 0};
    for (int c = 0; c < 3; ++c) f.field_uT(c) += random.normal(0, kNoise_uT);
    survey.push_back(f);
  };
  for (double y = first_m; y <= 6.0; y += lane_m) {
    for (double x = 0.0; x <= 8.0; x += 0.05) read(x, y, 0.0);
    for (double x = 8.0; x >= 0.0; x -= 0.05) read(x, y, kPi);
  }
  return survey;
}

FieldMapOptions with(KernelChoice kernel) {
  FieldMapOptions options;
  options.resolution_m = 0.1;
  options.reach_m = 1.0;
  options.analysis.kernel = kernel;
  return options;
}

TEST(ChooseKernel, TakesTheHarmonicOneWhereTheFieldIsThatOfSteelAndForetellsLanesBetterSo) {
  Random random(11);
  const test::PoleSheets sheets(SourceSide::kBelow, random);
  const auto survey = survey_over_poles(sheets, 0.0, 0.6, random);
  const auto analysis = test::must(analyse_survey(survey, FieldModel::kGpr));
  ASSERT_TRUE(analysis.harmonic.has_value());
  EXPECT_EQ(analysis.harmonic->side, SourceSide::kBelow);
  EXPECT_NEAR(std::log(analysis.harmonic->depth_m), 0.0, 0.3);
  EXPECT_TRUE(analysis.kernel_comparison->favours_harmonic());
  // The reference: lanes in the middle between the survey's.
  const auto between = survey_over_poles(sheets, 0.3, 0.6, random);
  const auto check = [&](KernelChoice kernel) {
    const FieldMap map = test::must(build_field_map(survey, nullptr, with(kernel)));
    return check_field_map(map, between).score;
  };
  const HeldOutScore harmonic = check(KernelChoice::kAuto),
                     independent = check(KernelChoice::kSquaredExponential);
  EXPECT_LT(harmonic.rms_uT.matrix().norm(), 0.8 * independent.rms_uT.matrix().norm());
  for (int c = 0; c < 3; ++c) EXPECT_GT(harmonic.within_2_sigma(c), 0.85) << c;
}

TEST(ChooseKernel, KeepsIndependentComponentsWhereTheyAreNoGradient) {
  Random random(12);
  const test::WavyField field(0.6, 7.0, random);
  const auto survey = test::drive(field, {}, random);
  const auto analysis = test::must(analyse_survey(survey, FieldModel::kGpr));
  ASSERT_TRUE(analysis.kernel_comparison.has_value());
  EXPECT_FALSE(analysis.harmonic.has_value());
  EXPECT_FALSE(analysis.kernel_comparison->favours_harmonic());
}

TEST(ChooseKernel, AHarmonicOneOnRequestIsTakenEvenSo) {
  Random random(12);
  const test::WavyField field(0.6, 7.0, random);
  SurveyAnalysisOptions options;
  options.kernel = KernelChoice::kHarmonic;
  const auto survey = test::drive(field, {}, random);
  EXPECT_TRUE(test::must(analyse_survey(survey, FieldModel::kGpr, options)).harmonic.has_value());
  options.hyperparameters = FieldHyperparameters{};
  EXPECT_FALSE(analyse_survey(survey, FieldModel::kGpr, options).ok());
}

TEST(ChooseKernel, ThreadsDoNotChangeTheMap) {
  Random random(13);
  const test::PoleSheets sheets(SourceSide::kBoth, random);
  const auto survey = survey_over_poles(sheets, 0.0, 1.0, random);
  FieldMapOptions options = with(KernelChoice::kHarmonic);
  const FieldMap map = test::must(build_field_map(survey, nullptr, options));
  options.threads = Threads{1};
  const FieldMap alone = test::must(build_field_map(survey, nullptr, options));
  ASSERT_EQ(map.mean_uT.size(), alone.mean_uT.size());
  for (std::size_t i = 0; i < map.mean_uT.size(); ++i) {
    if (!map.has_value(map.geometry.cell(i))) continue;
    ASSERT_EQ(map.mean_uT[i], alone.mean_uT[i]);
    ASSERT_EQ(map.variance_uT2[i], alone.variance_uT2[i]);
  }
}

}  // namespace
}  // namespace mstsl
