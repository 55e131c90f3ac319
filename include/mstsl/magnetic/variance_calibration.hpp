#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include <Eigen/Core>

#include "mstsl/magnetic/cross_validation.hpp"

/// What a field map's variance must be for later readings to be as far off as it says.
namespace mstsl {

/// How the variance v that a regression gives itself becomes that of a later reading. A survey's field is not
/// equally strong everywhere: beside a rack of steel a map is off by tens of uT, three metres on by a tenth
/// of one. So with the strength a of the field around a place (see FieldStrength; 1 on average):
///
///     odds v' : (prior - v')  =  factor a^power  times  v : (prior - v),     plus (even^2 + uneven^2
///     a^power)
///
/// where the prior's variance is itself multiplied by a^power if that is above 1. A place far from all
/// fingerprints (a = 1, v = prior) keeps the prior's.
struct VarianceCalibration {
  Eigen::Array3d factor = Eigen::Array3d::Ones();
  /// Standard deviation of a reading where the field is known, uT: everywhere the same ...
  Eigen::Array3d even_sd_uT = Eigen::Array3d::Zero();
  /// ... and with the field's strength: a position that is a centimetre off matters beside steel.
  Eigen::Array3d uneven_sd_uT = Eigen::Array3d::Zero();
  Eigen::Array3d power = Eigen::Array3d::Zero();
  /// Standard deviation of the field where nothing is known.
  Eigen::Array3d prior_sd_uT = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());

  Eigen::Array3d apply(const Eigen::Array3d& variance_uT2, double strength = 1.0) const;
  double apply(int component, double variance_uT2, double strength) const;
  /// Of a reading where the map is sure.
  Eigen::Array3d reading_variance_uT2(double strength = 1.0) const;
};

/// How errors are distributed: with heavy tails (Student's t, 4 degrees of freedom: steel that one lane
/// passes and the next does not), so that a few wild ones do not decide what the map is worth elsewhere; or
/// without (Gaussian), once wild ones are left out.
enum class Tails { kHeavy, kNone };

/// The calibration under which held-out errors are most probable, component by component; 68 % of them lie
/// within one standard deviation. Starts from, and with few errors stays near, `prior`.
VarianceCalibration calibrate(std::span<const HeldOutError> errors, const VarianceCalibration& prior,
                              Tails tails = Tails::kHeavy);

/// A calibration, and the radius (m) within which the field's strength is measured for it; 0: none is.
struct LocalCalibration {
  VarianceCalibration of_variance;
  double strength_radius_m = 0.0;
};

/// The prior of the above for a regression that has its own noise.
VarianceCalibration uncalibrated(const Eigen::Array3d& noise_sd_uT, const Eigen::Array3d& prior_sd_uT);

/// Log of the density of an error's three components under that, mean over the errors, without the constant.
double mean_log_density(std::span<const HeldOutError> errors, const VarianceCalibration& calibration);

/// How well predictions held: rms error, and the shares of errors within 1 and 2 of their own standard
/// deviations (0.68 and 0.95 for an honest Gaussian).
struct HeldOutScore {
  std::size_t errors = 0;
  Eigen::Array3d rms_uT = Eigen::Array3d::Zero();
  Eigen::Array3d within_1_sigma = Eigen::Array3d::Zero();
  Eigen::Array3d within_2_sigma = Eigen::Array3d::Zero();
};
HeldOutScore score(std::span<const HeldOutError> errors, const VarianceCalibration& calibration);

}  // namespace mstsl
