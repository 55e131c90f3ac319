#pragma once

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/scan/local_map.hpp"

namespace mstsl {

/// Eq. 5, the paper's motion model: straight on by `distance_m` in the direction of the heading, then a turn
/// by `turn_rad`. The straight-line case of composing poses, from * (distance, 0, turn); hypotheses are moved
/// by the whole composition, map_T_base * base_T_moved, which holds for curves as well.
Pose2 straight_motion(const Pose2& from, double distance_m, double turn_rad);

/// The covariance (x, y, yaw; map frame) of map_T_base * step, for a pose of covariance `covariance` and a
/// step by odometry with its errors: first order.
Eigen::Matrix3d moved_covariance(const Pose2& map_T_base, const Eigen::Matrix3d& covariance,
                                 const Pose2& step, const OdometryNoise& noise);

}  // namespace mstsl
