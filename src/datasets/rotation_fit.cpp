#include "mstsl/datasets/rotation_fit.hpp"

#include <cassert>
#include <cstddef>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace mstsl::datasets {

Eigen::Vector3d residual_rms(const Eigen::Matrix3d& to_R_from, std::span<const Eigen::Vector3d> from,
                             std::span<const Eigen::Vector3d> to) {
  assert(from.size() == to.size() && !from.empty());
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) sum += (to[i] - to_R_from * from[i]).array().square();
  return (sum / static_cast<double>(from.size())).sqrt();
}

Result<RotationFit> fit_rotation(std::span<const Eigen::Vector3d> from, std::span<const Eigen::Vector3d> to) {
  assert(from.size() == to.size());
  Eigen::Matrix3d attitude_profile = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) attitude_profile += to[i] * from[i].transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(attitude_profile, Eigen::ComputeFullU | Eigen::ComputeFullV);
  // Two independent directions fix a rotation; below this share the second one is rounding, not direction.
  constexpr double kLeastShare = 1e-9;
  if (!(svd.singularValues()[1] > kLeastShare * svd.singularValues()[0]))
    return Error(
        "the vectors to fit a rotation to all lie along one line; a turn about it cannot be told from them");
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant() > 0 ? 1.0 : -1.0;
  RotationFit fit;
  fit.to_R_from =
      svd.matrixU() * Eigen::Vector3d(1.0, 1.0, handedness).asDiagonal() * svd.matrixV().transpose();
  fit.residual_rms = residual_rms(fit.to_R_from, from, to);
  return fit;
}

}  // namespace mstsl::datasets
