#include "mstsl/core/pose2.hpp"

#include <cmath>

#include "mstsl/core/angles.hpp"

namespace mstsl {

Pose2 Pose2::from(const Eigen::Vector2d& position_m, double yaw_rad) {
  return {position_m.x(), position_m.y(), wrap_angle(yaw_rad)};
}

Eigen::Matrix2d Pose2::rotation() const { return Eigen::Rotation2Dd(yaw).toRotationMatrix(); }

bool Pose2::is_finite() const { return std::isfinite(x) && std::isfinite(y) && std::isfinite(yaw); }

Pose2 operator*(const Pose2& a_T_b, const Pose2& b_T_c) {
  return Pose2::from(a_T_b * b_T_c.position(), a_T_b.yaw + b_T_c.yaw);
}

Eigen::Vector2d operator*(const Pose2& a_T_b, const Eigen::Vector2d& point_b_m) {
  return a_T_b.rotation() * point_b_m + a_T_b.position();
}

Pose2 inverse(const Pose2& a_T_b) {
  return Pose2::from(-(a_T_b.rotation().transpose() * a_T_b.position()), -a_T_b.yaw);
}

Pose2 between(const Pose2& m_T_a, const Pose2& m_T_b) { return inverse(m_T_a) * m_T_b; }

Pose2 interpolate(const Pose2& from, const Pose2& to, double fraction) {
  return Pose2::from(from.position() + fraction * (to.position() - from.position()),
                     from.yaw + fraction * angle_between(from.yaw, to.yaw));
}

Eigen::Isometry3d to_isometry3(const Pose2& pose) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(pose.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  motion.translation() << pose.x, pose.y, 0.0;
  return motion;
}

Pose2 to_pose2(const Eigen::Isometry3d& motion) {
  return {motion.translation().x(), motion.translation().y(),
          std::atan2(motion.linear()(1, 0), motion.linear()(0, 0))};
}

Eigen::Vector3d difference(const Pose2& from, const Pose2& to) {
  return {to.x - from.x, to.y - from.y, angle_between(from.yaw, to.yaw)};
}

double distance(const Pose2& a, const Pose2& b) { return (a.position() - b.position()).norm(); }

}  // namespace mstsl
