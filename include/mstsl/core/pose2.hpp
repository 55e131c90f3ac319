#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace mstsl {

/// A pose in the plane, and the rigid motion it stands for: `a_T_b` maps coordinates of frame b to frame a.
/// x and y in m; yaw in rad, counter-clockwise, kept in (-pi, pi] by every operation here.
struct Pose2 {
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;

  static Pose2 from(const Eigen::Vector2d& position_m, double yaw_rad);

  Eigen::Vector2d position() const { return {x, y}; }
  Eigen::Matrix2d rotation() const;
  bool is_finite() const;
};

/// a_T_c = a_T_b * b_T_c.
Pose2 operator*(const Pose2& a_T_b, const Pose2& b_T_c);

/// The point in frame a: R p + t.
Eigen::Vector2d operator*(const Pose2& a_T_b, const Eigen::Vector2d& point_b_m);

/// b_T_a.
Pose2 inverse(const Pose2& a_T_b);

/// a_T_b for two poses given in the same frame: inverse(m_T_a) * m_T_b.
Pose2 between(const Pose2& m_T_a, const Pose2& m_T_b);

/// The pose a share `fraction` of the way from one to the other: straight in position, the short way in yaw.
Pose2 interpolate(const Pose2& from, const Pose2& to, double fraction);

/// The planar pose as a rigid motion in space (z = 0, roll = pitch = 0), to chain it with sensor mountings.
Eigen::Isometry3d to_isometry3(const Pose2& pose);

/// The planar part of a rigid motion: x, y and the yaw of its x axis seen from above.
Pose2 to_pose2(const Eigen::Isometry3d& motion);

/// x, y and yaw of `to` less those of `from`, both given in one frame; the yaw the short way round.
Eigen::Vector3d difference(const Pose2& from, const Pose2& to);

double distance(const Pose2& a, const Pose2& b);

}  // namespace mstsl
