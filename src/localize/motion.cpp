#include "mstsl/localize/motion.hpp"

#include <cmath>

namespace mstsl {

Pose2 straight_motion(const Pose2& from, double distance_m, double turn_rad) {
  return Pose2::from({from.x + distance_m * std::cos(from.yaw), from.y + distance_m * std::sin(from.yaw)},
                     from.yaw + turn_rad);
}

Eigen::Matrix3d by_pose_before(const Pose2& map_T_base, const Pose2& step) {
  const Eigen::Vector2d shift = map_T_base.rotation() * step.position();
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Identity();
  by_pose(0, 2) = -shift.y();
  by_pose(1, 2) = shift.x();
  return by_pose;
}

Eigen::Matrix3d in_map(const Pose2& map_T_base, const Eigen::Matrix3d& step_covariance) {
  Eigen::Matrix3d by_step = Eigen::Matrix3d::Identity();
  by_step.topLeftCorner<2, 2>() = map_T_base.rotation();
  return by_step * step_covariance * by_step.transpose();
}

Eigen::Matrix3d moved_covariance(const Pose2& map_T_base, const Eigen::Matrix3d& covariance,
                                 const Pose2& step, const OdometryNoise& noise) {
  const Eigen::Matrix3d by_pose = by_pose_before(map_T_base, step);
  return by_pose * covariance * by_pose.transpose() + in_map(map_T_base, noise.covariance(step));
}

}  // namespace mstsl
