#pragma once

#include <span>

#include <Eigen/Core>

#include "mstsl/core/result.hpp"

namespace mstsl::datasets {

/// The rotation that turns one set of vectors into another, and what is left.
struct RotationFit {
  Eigen::Matrix3d to_R_from = Eigen::Matrix3d::Identity();
  Eigen::Vector3d residual_rms =
      Eigen::Vector3d::Zero();  ///< per component of to - R from, in the vectors' unit
};

/// Root mean square of to_i - R from_i, per component. Expects as many of the one as of the other, and at
/// least one.
Eigen::Vector3d residual_rms(const Eigen::Matrix3d& to_R_from, std::span<const Eigen::Vector3d> from,
                             std::span<const Eigen::Vector3d> to);

/// Least squares over sum |to_i - R from_i|^2 (Wahba 1965), by singular values (Kabsch 1976; Markley 1988).
/// Expects as many of the one as of the other. Errors: vectors that all lie along one line, which leave a
/// turn about it open.
Result<RotationFit> fit_rotation(std::span<const Eigen::Vector3d> from, std::span<const Eigen::Vector3d> to);

}  // namespace mstsl::datasets
