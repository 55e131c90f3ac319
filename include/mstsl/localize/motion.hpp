#pragma once

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"

namespace mstsl {

/// Eq. 5, the paper's motion model: straight on by `distance_m` in the direction of the heading, then a turn
/// by `turn_rad`. The straight-line case of composing poses, from * (distance, 0, turn); hypotheses are moved
/// by the whole composition, map_T_base * base_T_moved, which holds for curves as well.
Pose2 straight_motion(const Pose2& from, double distance_m, double turn_rad);

/// How wheel odometry errs, as standard deviations; the defaults are those of the recovered odometry of real
/// robots (ACES, Intel, Freiburg: about 10 % of the way and 3 deg on half a metre) halved, since those are of
/// steps with slip on the spot, and 2 % of a turn.
struct OdometryErrors {
  double position_share = 0.05;  ///< of the distance, m/m, along and across
  double yaw_per_m_rad = 0.05;   ///< rad/m
  double yaw_share = 0.02;       ///< of the turn, rad/rad
};

/// The covariance (x, y, yaw; map frame) of map_T_base * step, for a pose of covariance `covariance` and a
/// step by odometry with its errors: first order.
Eigen::Matrix3d moved_covariance(const Pose2& map_T_base, const Eigen::Matrix3d& covariance,
                                 const Pose2& step, const OdometryErrors& errors);

}  // namespace mstsl
