#pragma once

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/scan/local_map.hpp"

namespace mstsl {

/// Eq. 5, the paper's motion model: straight on by `distance_m` in the direction of the heading, then a turn
/// by `turn_rad`. The straight-line case of composing poses, from * (distance, 0, turn); hypotheses are moved
/// by the whole composition, map_T_base * base_T_moved, which holds for curves as well.
Pose2 straight_motion(const Pose2& from, double distance_m, double turn_rad);

/// How map_T_base * step changes with map_T_base (x, y, yaw; map frame): a turn of the base swings the step.
Eigen::Matrix3d by_pose_before(const Pose2& map_T_base, const Pose2& step);

/// The covariance of a step, given in the axes of the base before it, in the map's.
Eigen::Matrix3d in_map(const Pose2& map_T_base, const Eigen::Matrix3d& step_covariance);

/// The covariance (x, y, yaw; map frame) of map_T_base * step, for a pose of covariance `covariance` and a
/// step by odometry with its errors: first order.
Eigen::Matrix3d moved_covariance(const Pose2& map_T_base, const Eigen::Matrix3d& covariance,
                                 const Pose2& step, const OdometryNoise& noise);

}  // namespace mstsl
