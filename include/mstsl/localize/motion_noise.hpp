#pragma once

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"

namespace mstsl {

/// Odometry's error, as a random walk: standard deviations after 1 m driven or 1 rad turned, growing with the
/// root of the way, so that it does not matter in how many steps a way is driven. Between the wheels of real
/// robots (ACES, Intel: 7 cm and 2.6-3.5 deg after half a metre) and those of a good one (3 % of scale are
/// 0.1 m after 10 m).
struct MotionNoise {
  double m_per_root_m = 0.07;
  double rad_per_root_m = 0.045;
  double rad_per_root_rad = 0.05;
  double floor_m = 0.003;  ///< at every step, also when standing
  double floor_rad = 0.002;

  /// Of the motion's x, y (m) and yaw (rad), in the frame it starts from.
  Eigen::Matrix3d covariance(const Pose2& motion) const;
};

}  // namespace mstsl
