#pragma once

#include <algorithm>
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

/// Moves the map error on by `way_m`: a Matern 3/2 process of stationary variance `variance`, in its
/// state-space form (Hartikainen & Sarkka, "Kalman filtering and smoothing solutions to temporal Gaussian
/// process regression models", 2010, Eq. 12-16), its slope counted per `length_m` / sqrt(3).
inline void let_wander(Vector& state, Covariance& covariance, double way_m, double length_m,
                       const Eigen::Vector3d& variance) {
  const double a = std::min(std::sqrt(3.0) * way_m / length_m, 50.0), fade = std::exp(-a);
  const double ee = fade * (1 + a), es = fade * a, se = -fade * a, ss = fade * (1 - a);
  const auto mix = [&](auto&& error, auto&& slope) {
    const auto before = error.eval();
    error = ee * before + es * slope;
    slope = se * before + ss * slope.eval();
  };
  mix(state.segment<3>(kMapError), state.segment<3>(kMapErrorSlope));
  mix(covariance.middleRows<3>(kMapError), covariance.middleRows<3>(kMapErrorSlope));
  mix(covariance.middleCols<3>(kMapError), covariance.middleCols<3>(kMapErrorSlope));
  covariance.diagonal().segment<3>(kMapError) += (1 - ee * ee - es * es) * variance;
  covariance.diagonal().segment<3>(kMapErrorSlope) += (1 - se * se - ss * ss) * variance;
  const Eigen::Vector3d cross = -(ee * se + es * ss) * variance;
  covariance.block<3, 3>(kMapError, kMapErrorSlope).diagonal() += cross;
  covariance.block<3, 3>(kMapErrorSlope, kMapError).diagonal() += cross;
}

/// Forgets the map error and its slope: anything of that variance.
inline void forget_map_error(Vector& state, Covariance& covariance, const Eigen::Vector3d& variance) {
  constexpr int kRest = kStates - kMapError;
  state.tail<kRest>().setZero();
  covariance.bottomRows<kRest>().setZero();
  covariance.rightCols<kRest>().setZero();
  covariance.diagonal().tail<kRest>() << variance, variance;
}

}  // namespace mstsl::joint
