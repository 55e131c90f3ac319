#pragma once

#include <optional>

#include "mstsl/core/pose2.hpp"

namespace mstsl::io::carmen {

/// Recovers the wheels' own odometry from a log whose authors corrected the poses.
///
/// In such a log the ODOM line after each scan k repeats the scan's corrected pose F_k, and those that follow
/// are counted from there. The wheels' motion between two scans is therefore inv(F_k) * (last ODOM before
/// scan k+1); chained, these make a frame `odom` that drifts as the wheels did and never jumps. In a raw log
/// no ODOM line is such a new start, and the poses come out as they are.
class WheelOdometry {
 public:
  /// The pose in the continuous frame; nothing for a line that only marks a new start, whose stamp means
  /// nothing.
  std::optional<Pose2> at_odometry(const Pose2& line_pose);
  /// The pose at a scan, by the odometry before it.
  void at_scan(const Pose2& corrected_pose);

 private:
  Pose2 odom_T_line_frame_;             ///< from the frame that ODOM lines are counted in just now
  Pose2 odom_T_base_;                   ///< by the last line
  std::optional<Pose2> awaited_start_;  ///< the corrected pose of the scan just before
};

}  // namespace mstsl::io::carmen
