#include "mstsl/magnetic/variance_calibration.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

using Eigen::Array3d;

VarianceCalibration a_truth() {
  VarianceCalibration truth;
  truth.factor.setConstant(4.0);
  truth.even_sd_uT.setConstant(0.6);
  truth.prior_sd_uT.setConstant(7.0);
  return truth;
}

/// Gaussian errors whose true variance is known.
std::vector<HeldOutError> errors_under(const VarianceCalibration& truth, std::uint64_t seed) {
  Random random(seed);
  std::vector<HeldOutError> errors(4000);
  for (HeldOutError& e : errors) {
    e.variance_uT2.setConstant(std::pow(10.0, random.uniform(-2.0, 1.0)));
    e.strength = std::pow(10.0, random.uniform(-2.0, 1.0));
    const Array3d variance = truth.apply(e.variance_uT2, e.strength);
    for (int c = 0; c < 3; ++c) e.error_uT(c) = random.normal() * std::sqrt(variance(c));
  }
  return errors;
}

TEST(Calibrate, FindsTheFactorAndTheNoiseOfAReading) {
  const VarianceCalibration start = uncalibrated(Array3d::Constant(0.1), Array3d::Constant(7.0));
  const auto errors = errors_under(a_truth(), 41);
  const auto found = calibrate(errors, start);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(found.factor(c) / 4.0, 1.0, 0.2);
    EXPECT_NEAR(std::sqrt(found.reading_variance_uT2()(c)) / 0.6, 1.0, 0.1);
    EXPECT_LT(found.power(c), 0.1);
  }
  const HeldOutScore before = score(errors, start), after = score(errors, found);
  EXPECT_LT(before.within_1_sigma.maxCoeff(), 0.5);  // overconfident
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(after.within_1_sigma(c), 0.683, 0.03);
    EXPECT_NEAR(after.within_2_sigma(c), 0.954, 0.02);
  }
  EXPECT_TRUE((before.rms_uT == after.rms_uT).all());
}

TEST(Calibrate, FindsHowErrorsGrowWithTheField) {
  VarianceCalibration truth = a_truth();
  truth.power << 0.8, 1.5, 2.0;
  truth.uneven_sd_uT.setConstant(0.5);
  const auto errors = errors_under(truth, 42);
  const auto found = calibrate(errors, uncalibrated(Array3d::Constant(0.3), Array3d::Constant(7.0)));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found.power(c), truth.power(c), 0.15);
  // Honest in calm and in strong places alike, which one number for all cannot be.
  for (const bool calm : {false, true}) {
    std::vector<HeldOutError> some;
    for (const HeldOutError& e : errors)
      if ((e.strength < 0.1) == calm) some.push_back(e);
    const HeldOutScore here = score(some, found);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(here.within_1_sigma(c), 0.683, 0.05);
  }
}

TEST(Calibrate, IsNotDecidedByAFewWildErrors) {
  auto errors = errors_under(a_truth(), 43);
  for (std::size_t i = 0; i < errors.size(); i += 50) errors[i].error_uT *= 50.0;
  const auto found = calibrate(errors, uncalibrated(Array3d::Constant(0.1), Array3d::Constant(7.0)));
  const HeldOutScore after = score(errors, found);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(after.within_1_sigma(c), 0.683, 0.05);
}

TEST(Calibrate, StaysWithThePriorWithoutErrors) {
  const VarianceCalibration start = a_truth();
  const auto found = calibrate({}, start);
  EXPECT_TRUE(found.factor.isApprox(start.factor, 1e-9));
  EXPECT_TRUE(found.even_sd_uT.isApprox(start.even_sd_uT, 1e-9));
}

TEST(Calibrate, StaysFiniteWhateverTheErrors) {
  for (const double error : {0.0, 1e-12, 1e6}) {
    std::vector<HeldOutError> errors(20);
    for (HeldOutError& e : errors) {
      e.error_uT.setConstant(error);
      e.variance_uT2.setConstant(1.0);
      e.strength = error;
    }
    const auto found = calibrate(errors, uncalibrated(Array3d::Constant(0.1), Array3d::Constant(7.0)));
    const Array3d variance = found.apply(Array3d::Ones(), error);
    EXPECT_TRUE(variance.isFinite().all());
    EXPECT_GT(variance.minCoeff(), 0.0);
  }
}

TEST(VarianceCalibration, KeepsThePriorWhereNothingIsKnown) {
  VarianceCalibration calibration;
  calibration.factor.setConstant(9.0);
  calibration.prior_sd_uT.setConstant(7.0);
  calibration.power.setConstant(1.5);
  EXPECT_NEAR(calibration.apply(Array3d::Constant(49.0)).x(), 49.0, 1e-12);
  EXPECT_NEAR(calibration.apply(Array3d::Constant(0.01)).x(), 0.09, 1e-3);
}

TEST(VarianceCalibration, GrowsWithTheFieldAndWithWhatTheRegressionSays) {
  VarianceCalibration calibration = a_truth();
  calibration.power.setConstant(1.3);
  calibration.uneven_sd_uT.setConstant(0.2);
  for (double strength = 0.001; strength < 100.0; strength *= 1.7)
    for (double variance = 0.01; variance < 40.0; variance *= 1.7) {
      const double here = calibration.apply(Array3d::Constant(variance), strength).x();
      EXPECT_GT(calibration.apply(Array3d::Constant(variance), 1.1 * strength).x(), here);
      EXPECT_GT(calibration.apply(Array3d::Constant(1.1 * variance), strength).x(), here);
    }
}

}  // namespace
}  // namespace mstsl
