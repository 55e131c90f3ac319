#include "mstsl/magnetic/learn_hyperparameters.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "hand_made_survey.hpp"
#include "test_support.hpp"

namespace mstsl {
namespace {

using test::drive;
using test::must;
using test::SurveyPlan;
using test::WavyField;

class LengthScales : public ::testing::TestWithParam<double> {};

TEST_P(LengthScales, AreFoundWithinAQuarterAndTheNoiseToo) {
  const double length_m = GetParam();
  Random random(21);
  const WavyField field(length_m, 7.0, random);
  SurveyPlan plan{20.0 * length_m, 14.0 * length_m, 0.7 * length_m, 0.1 * length_m, 0.5, 0.05 * length_m};
  const auto learned = must(learn_hyperparameters(drive(field, plan, random)));
  EXPECT_NEAR(learned.values.length_scale_m(0) / length_m, 1.0, 0.25);
  for (int c = 0; c < 3; ++c) {
    // The survey's own deviation is that of one draw over a dozen length scales.
    EXPECT_NEAR(learned.values.signal_sd_uT(c) / 7.0, 1.0, 0.35);
    EXPECT_NEAR(learned.values.noise_sd_uT(c) / 0.5, 1.0, 0.45);
  }
}

INSTANTIATE_TEST_SUITE_P(Metres, LengthScales, ::testing::Values(0.25, 0.45, 0.8, 1.5, 3.0));

std::vector<Fingerprint> a_survey(std::uint64_t seed) {
  Random random(seed);
  const WavyField field(0.6, 7.0, random);
  return drive(field, {}, random);
}

TEST(LearnHyperparameters, AreAsLargeInAFieldTenTimesAsLarge) {
  const std::vector<Fingerprint> survey = a_survey(1);
  std::vector<Fingerprint> larger = survey;
  for (Fingerprint& f : larger) f.field_uT *= 10.0;
  const auto a = must(learn_hyperparameters(survey)).values, b = must(learn_hyperparameters(larger)).values;
  EXPECT_NEAR(b.length_scale_m(0) / a.length_scale_m(0), 1.0, 1e-3);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(b.signal_sd_uT(c) / a.signal_sd_uT(c), 10.0, 1e-6);
    EXPECT_NEAR(b.noise_sd_uT(c) / a.noise_sd_uT(c), 10.0, 1e-2);
    EXPECT_NEAR(b.mean_uT(c) / a.mean_uT(c), 10.0, 1e-2);
  }
}

TEST(LearnHyperparameters, AConstantFieldMovesTheMeanAlone) {
  const std::vector<Fingerprint> survey = a_survey(2);
  std::vector<Fingerprint> moved = survey;
  const Eigen::Vector3d offset(5.0, -30.0, 12.0);
  for (Fingerprint& f : moved) f.field_uT += offset;
  const auto a = must(learn_hyperparameters(survey)).values, b = must(learn_hyperparameters(moved)).values;
  EXPECT_NEAR(b.length_scale_m(0), a.length_scale_m(0), 1e-3);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(b.mean_uT(c) - a.mean_uT(c), offset(c), 1e-2);
}

TEST(LearnHyperparameters, AreTheSameAtAnyNumberOfThreads) {
  const std::vector<Fingerprint> survey = a_survey(3);
  LearningOptions one, five;
  one.threads = {1};
  five.threads = {5};
  EXPECT_EQ(to_named(must(learn_hyperparameters(survey, one)).values),
            to_named(must(learn_hyperparameters(survey, five)).values));
}

TEST(LearnHyperparameters, SaysWhereItCannotTell) {
  std::vector<Fingerprint> flat = a_survey(4);
  Random random(5);
  for (Fingerprint& f : flat)
    f.field_uT = Eigen::Vector3d(20, 0, -40) + 1e-3 * Eigen::Vector3d::Constant(random.normal());
  const auto learned = must(learn_hyperparameters(flat));
  EXPECT_TRUE(is_valid(learned.values));
  ASSERT_FALSE(learned.warnings.empty());
  EXPECT_NE(learned.warnings.back().find("nothing here tells places apart"), std::string::npos);
}

TEST(LearnHyperparameters, RefusesTooFewAndWhatIsNotFinite) {
  std::vector<Fingerprint> survey = a_survey(6);
  EXPECT_FALSE(learn_hyperparameters(std::span(survey).first(19)));
  EXPECT_TRUE(learn_hyperparameters(std::span(survey).first(20)));
  survey[3].position_m.x() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(learn_hyperparameters(survey));
}

}  // namespace
}  // namespace mstsl
