#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "mstsl/localize/joint/mode.hpp"

/// The arithmetic that a mode and the unknown place share.
namespace mstsl::joint {

using Observation = Eigen::Matrix<double, 3, kStates>;

inline double square(double x) { return x * x; }

inline Eigen::Matrix3d about_z(double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  Eigen::Matrix3d r;
  r << c, -s, 0, s, c, 0, 0, 0, 1;
  return r;
}

/// What part of a station's errors was not there at the last one (0 .. 1): none while the robot turns on the
/// spot.
inline double news_of(const Station& station, const FieldModel& model) {
  return 1.0 - std::exp(-2.0 * station.since_last_m / model.error_own_length_m);
}

/// Variance of a station's reading (uT^2) whatever the map says.
inline double reading_variance(const Station& station, const FieldModel& model, double news) {
  return station.variance_uT2 + square(model.station_sigma_uT) +
         (1.0 - news) * square(model.turning_sigma_uT);
}

/// How far an observation is off what was expected, judged by Student's t with so many degrees of freedom:
/// fields beside strong steel are off by ten standard deviations, and by a Gaussian such a reading would
/// decide between two places that both fail to explain it.
struct Surprise {
  Eigen::LLT<Eigen::Matrix3d> llt;  ///< of the expected covariance
  Eigen::Vector3d off;
  double squared = 0.0;  ///< in standard deviations

  static constexpr double kFreedom = 4.0;

  Surprise(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& off_uT) : llt(covariance), off(off_uT) {
    squared = llt.matrixL().solve(off).squaredNorm();
  }
  /// Natural log of the density, but for a constant, the variances being `factor` times what was expected.
  double log_density(double factor = 1.0) const {
    return -0.5 * (kFreedom + 3) * std::log1p(squared / (factor * kFreedom)) -
           llt.matrixLLT().diagonal().array().log().sum() - 1.5 * std::log(factor);
  }
  /// By how much the covariance must grow for the reading to be an ordinary one.
  double inflation() const { return std::max(1.0, (kFreedom + squared) / (kFreedom + 3)); }
};

/// The Kalman update, a surprising observation counting less; returns the change of the state.
inline Vector correct(Covariance& covariance, const Observation& by_state, const Surprise& surprise) {
  const Eigen::Matrix<double, kStates, 3> cross = covariance * by_state.transpose();
  const Eigen::Matrix<double, kStates, 3> gain =
      surprise.llt.solve(cross.transpose()).transpose() / surprise.inflation();
  covariance.noalias() -= gain * cross.transpose();
  covariance = (0.5 * (covariance + covariance.transpose())).eval();
  return gain * surprise.off;
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
