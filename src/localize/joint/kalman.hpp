#pragma once

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "mstsl/localize/joint/mode.hpp"

/// The arithmetic that a mode and the unknown place share.
namespace mstsl::joint {

using Observation = Eigen::Matrix<double, 3, kStates>;

inline Eigen::Matrix3d about_z(double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  Eigen::Matrix3d r;
  r << c, -s, 0, s, c, 0, 0, 0, 1;
  return r;
}

/// Natural log of N(off; 0, covariance).
inline double log_density(const Eigen::Vector3d& off, const Eigen::LLT<Eigen::Matrix3d>& llt) {
  constexpr double kLogTwoPi = 1.8378770664093453;
  const Eigen::Vector3d whitened = llt.matrixL().solve(off);
  const double half_log_determinant = llt.matrixLLT().diagonal().array().log().sum();
  return -0.5 * whitened.squaredNorm() - half_log_determinant - 1.5 * kLogTwoPi;
}

/// The Kalman update; returns the change of the state.
inline Vector correct(Covariance& covariance, const Observation& by_state, const Eigen::Vector3d& off,
                      const Eigen::LLT<Eigen::Matrix3d>& llt) {
  const Eigen::Matrix<double, kStates, 3> cross = covariance * by_state.transpose();
  const Eigen::Matrix<double, kStates, 3> gain = llt.solve(cross.transpose()).transpose();
  covariance.noalias() -= gain * cross.transpose();
  covariance = (0.5 * (covariance + covariance.transpose())).eval();
  return gain * off;
}

/// One step of an Ornstein-Uhlenbeck process in the three last states: shrinks by `kept`, regains `variance`.
inline void let_wander(Vector& state, Covariance& covariance, double kept, const Eigen::Vector3d& variance) {
  state.segment<3>(kMapError) *= kept;
  covariance.block<3, kStates>(kMapError, 0) *= kept;
  covariance.block<kStates, 3>(0, kMapError) *= kept;
  covariance.diagonal().segment<3>(kMapError) += (1.0 - kept * kept) * variance;
}

/// Forgets the three last states: anything of that variance.
inline void forget(Vector& state, Covariance& covariance, const Eigen::Vector3d& variance) {
  state.segment<3>(kMapError).setZero();
  covariance.block<3, kStates>(kMapError, 0).setZero();
  covariance.block<kStates, 3>(0, kMapError).setZero();
  covariance.diagonal().segment<3>(kMapError) = variance;
}

}  // namespace mstsl::joint
