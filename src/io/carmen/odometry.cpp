#include "io/carmen/odometry.hpp"

#include <utility>

namespace mstsl::io::carmen {

std::optional<Pose2> WheelOdometry::at_odometry(const Pose2& line_pose) {
  const std::optional<Pose2> start = std::exchange(awaited_start_, std::nullopt);
  // Both are printed from the same number, so a new start is exactly equal.
  const bool is_start =
      start && start->x == line_pose.x && start->y == line_pose.y && start->yaw == line_pose.yaw;
  if (is_start) {
    odom_T_line_frame_ = odom_T_base_ * inverse(line_pose);
    return std::nullopt;
  }
  odom_T_base_ = odom_T_line_frame_ * line_pose;
  return odom_T_base_;
}

void WheelOdometry::at_scan(const Pose2& corrected_pose) { awaited_start_ = corrected_pose; }

}  // namespace mstsl::io::carmen
