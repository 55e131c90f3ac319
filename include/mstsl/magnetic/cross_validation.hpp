#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/parallel.hpp"
#include "mstsl/magnetic/fingerprint.hpp"

/// Cross-validation by lane: predict a stretch of the survey from everything but its own pass. Leaving out
/// single fingerprints instead would give the answer away, since the neighbours 5 cm before and after are all
/// but the same reading.
namespace mstsl {

/// A piece of one lane, and the fingerprints that may predict it. Indices into the survey.
struct HeldOutStretch {
  std::vector<std::size_t> tested;
  std::vector<std::size_t> training;
};

struct HoldOutOptions {
  std::size_t stretches = 60;  ///< at most; spread evenly over the lanes
  std::size_t tested = 8;      ///< fingerprints per stretch; more of the same stretch say little new
  std::size_t training = 500;  ///< at most, the nearest ones: what an exact solution takes in its stride
  double length_m = 1.0;  ///< of a stretch, and of what is left out before and after it on the same drive
  double radius_m = 0.0;  ///< fingerprints of other passes nearer than this are left out too
};

std::vector<HeldOutStretch> hold_out_lanes(std::span<const Fingerprint> fingerprints,
                                           const HoldOutOptions& options);

/// What a held-out fingerprint showed: how far off the prediction was, and the variance that the prediction
/// gave itself, without the noise of a reading.
struct HeldOutError {
  Eigen::Array3d error_uT = Eigen::Array3d::Zero();
  Eigen::Array3d variance_uT2 = Eigen::Array3d::Zero();
};

/// Predicts the field at points from fingerprints; nothing where it cannot.
using Predictor = std::function<std::vector<std::optional<FieldPrediction>>(
    std::span<const Fingerprint> training, std::span<const Eigen::Vector2d> points_m)>;

/// Errors of a predictor over stretches, in their order; points that it cannot predict are left out.
std::vector<HeldOutError> held_out_errors(std::span<const Fingerprint> fingerprints,
                                          const std::vector<HeldOutStretch>& stretches,
                                          const Predictor& predict, Threads threads);

/// How the variance v of a prediction becomes that of a later reading: the odds v : (prior - v) are
/// multiplied by `factor` (so v itself is, where it is small, and a place far from all data keeps the prior's
/// variance), and the variance of a reading is added.
struct VarianceCalibration {
  Eigen::Array3d factor = Eigen::Array3d::Ones();
  Eigen::Array3d reading_sd_uT = Eigen::Array3d::Zero();
  /// Standard deviation of the field where nothing is known.
  Eigen::Array3d prior_sd_uT = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());

  Eigen::Array3d apply(const Eigen::Array3d& variance_uT2) const;
};

/// The calibration under which the held-out errors are most probable (Gaussian, per component). Starts from,
/// and with few errors stays near, `prior`.
VarianceCalibration calibrate(std::span<const HeldOutError> errors, const VarianceCalibration& prior);

/// Weight of something of which `components` were measured, their deviations in standard deviations squared
/// and summed: the expected inverse variance, relative to that of good ones, where one in a hundred comes
/// with ten times the noise (a trolley that passed, a pose that jumped; contaminated normal, Tukey 1960). 1
/// for good ones, 1/2 at a squared sum of 23 for three components.
double noise_weight(double squared_deviations, int components);

/// Log of the density of an error's three components under such noise, without the constant.
double log_density(const HeldOutError& error, const VarianceCalibration& calibration);

/// The errors that such noise takes for good ones (weight above 1/2) once their own calibration is known.
std::vector<HeldOutError> good_errors(std::span<const HeldOutError> errors, const VarianceCalibration& prior);

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
