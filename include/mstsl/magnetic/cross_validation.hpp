#pragma once

#include <cstddef>
#include <functional>
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
  double strength = 1.0;        ///< of the field there, see FieldStrength
  std::size_t stretch = 0;      ///< which was held out
  std::size_t fingerprint = 0;  ///< that was foretold; index into the survey
};

/// Predicts the field at points from fingerprints; nothing where it cannot.
using Predictor = std::function<std::vector<std::optional<FieldPrediction>>(
    std::span<const Fingerprint> training, std::span<const Eigen::Vector2d> points_m)>;

/// Errors of a predictor over stretches, in their order; points that it cannot predict are left out.
std::vector<HeldOutError> held_out_errors(std::span<const Fingerprint> fingerprints,
                                          const std::vector<HeldOutStretch>& stretches,
                                          const Predictor& predict, Threads threads);

}  // namespace mstsl
