#include "mstsl/magnetic/cross_validation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/magnetic/predictors.hpp"

#include "hand_made_survey.hpp"

namespace mstsl {
namespace {

using test::drive;
using test::WavyField;

std::vector<Fingerprint> a_survey() {
  Random random(31);
  const WavyField field(0.6, 7.0, random);
  return drive(field, {8.0, 4.0, 0.5}, random);
}

double nearest_m(const std::vector<Fingerprint>& survey, std::size_t tested,
                 const std::vector<std::size_t>& training) {
  double nearest = 1e9;
  for (const std::size_t i : training)
    nearest = std::min(nearest, (survey[i].position_m - survey[tested].position_m).norm());
  return nearest;
}

TEST(HoldOutLanes, TrainsOnNothingOfItsOwnPass) {
  const auto survey = a_survey();
  HoldOutOptions options;
  options.length_m = 0.6;
  const auto stretches = hold_out_lanes(survey, options);
  ASSERT_GT(stretches.size(), 10u);
  for (const HeldOutStretch& s : stretches)
    for (const std::size_t tested : s.tested)
      for (const std::size_t i : s.training) {
        // A pass is 8 m of 5 cm steps with one heading: neighbours in the drive are not in the training.
        const bool same_pass = survey[i].heading_rad == survey[tested].heading_rad &&
                               std::abs(survey[i].position_m.y() - survey[tested].position_m.y()) < 1e-9;
        EXPECT_FALSE(same_pass);
      }
}

TEST(HoldOutLanes, KeepsTheRadiusClear) {
  const auto survey = a_survey();
  HoldOutOptions options;
  options.length_m = 0.6;
  options.radius_m = 0.3;
  for (const HeldOutStretch& s : hold_out_lanes(survey, options))
    for (const std::size_t tested : s.tested) EXPECT_GE(nearest_m(survey, tested, s.training), 0.3);
}

TEST(HoldOutLanes, WithoutTheRadiusTheOtherWayOfTheSameLaneIsThere) {
  const auto survey = a_survey();
  HoldOutOptions options;
  options.length_m = 0.6;
  for (const HeldOutStretch& s : hold_out_lanes(survey, options))
    EXPECT_LT(nearest_m(survey, s.tested[s.tested.size() / 2], s.training), 0.15);
}

TEST(HoldOutLanes, ASinglePassLeavesNothingToLearnFrom) {
  Random random(32);
  const WavyField field(0.6, 7.0, random);
  auto survey = drive(field, {8.0, 0.0}, random);
  survey.resize(survey.size() / 2);
  EXPECT_TRUE(hold_out_lanes(survey, {}).empty());
}

TEST(HeldOutErrors, AreThoseOfThePredictor) {
  const auto survey = a_survey();
  const auto stretches = hold_out_lanes(survey, {});
  const Predictor constant = [](std::span<const Fingerprint>, std::span<const Eigen::Vector2d> points) {
    return std::vector<std::optional<FieldPrediction>>(
        points.size(), FieldPrediction{Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(4, 5, 6)});
  };
  const auto errors = held_out_errors(survey, stretches, constant, {3});
  std::size_t k = 0;
  for (const HeldOutStretch& s : stretches)
    for (const std::size_t tested : s.tested) {
      ASSERT_LT(k, errors.size());
      EXPECT_EQ(errors[k].error_uT.matrix(), survey[tested].field_uT - Eigen::Vector3d(1, 2, 3));
      EXPECT_EQ(errors[k++].variance_uT2.z(), 6.0);
    }
  EXPECT_EQ(k, errors.size());
}

/// Errors whose true variance is known: a factor on what the map claims, plus that of a reading.
std::vector<HeldOutError> errors_with(double factor, double reading_sd_uT, double prior_sd_uT,
                                      std::uint64_t seed) {
  Random random(seed);
  std::vector<HeldOutError> errors(4000);
  VarianceCalibration truth;
  truth.factor.setConstant(factor);
  truth.reading_sd_uT.setConstant(reading_sd_uT);
  truth.prior_sd_uT.setConstant(prior_sd_uT);
  for (HeldOutError& e : errors) {
    e.variance_uT2.setConstant(std::pow(10.0, random.uniform(-2.0, 1.0)));
    for (int c = 0; c < 3; ++c) e.error_uT(c) = random.normal() * std::sqrt(truth.apply(e.variance_uT2)(c));
  }
  return errors;
}

TEST(Calibrate, FindsTheFactorAndTheNoiseOfAReading) {
  const VarianceCalibration start{Eigen::Array3d::Ones(), Eigen::Array3d::Constant(0.1),
                                  Eigen::Array3d::Constant(7.0)};
  const auto errors = errors_with(4.0, 0.6, 7.0, 41);
  const auto found = calibrate(errors, start);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(found.factor(c) / 4.0, 1.0, 0.15);
    EXPECT_NEAR(found.reading_sd_uT(c) / 0.6, 1.0, 0.1);
  }
  const HeldOutScore before = score(errors, start), after = score(errors, found);
  EXPECT_LT(before.within_1_sigma.maxCoeff(), 0.5);  // overconfident
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(after.within_1_sigma(c), 0.683, 0.03);
    EXPECT_NEAR(after.within_2_sigma(c), 0.954, 0.015);
  }
  EXPECT_TRUE((before.rms_uT == after.rms_uT).all());
}

TEST(Calibrate, StaysWithThePriorWithoutErrors) {
  const VarianceCalibration start{Eigen::Array3d::Constant(1.5), Eigen::Array3d::Constant(0.4),
                                  Eigen::Array3d::Constant(7.0)};
  const auto found = calibrate({}, start);
  EXPECT_TRUE(found.factor.isApprox(start.factor, 1e-9));
  EXPECT_TRUE(found.reading_sd_uT.isApprox(start.reading_sd_uT, 1e-9));
}

TEST(VarianceCalibration, KeepsThePriorWhereNothingIsKnown) {
  VarianceCalibration calibration;
  calibration.factor.setConstant(9.0);
  calibration.prior_sd_uT.setConstant(7.0);
  EXPECT_NEAR(calibration.apply(Eigen::Array3d::Constant(49.0)).x(), 49.0, 1e-12);
  EXPECT_NEAR(calibration.apply(Eigen::Array3d::Constant(0.01)).x(), 0.09, 1e-3);
}

}  // namespace
}  // namespace mstsl
