#pragma once

#include "mstsl/core/pose2.hpp"

namespace mstsl {

/// What is constantly wrong with a robot's odometry, as learned from its scans.
struct WheelCalibration {
  double scale = 0.0;            ///< ways are longer by this share than they are said to be
  double drift_rad_per_m = 0.0;  ///< the robot turns by this for each metre ahead, unseen by odometry
  double turn_scale = 0.0;       ///< turns are larger by this share

  /// A motion as it was, from what odometry said.
  Pose2 corrected(const Pose2& motion) const {
    return Pose2::from((1.0 + scale) * motion.position(),
                       (1.0 + turn_scale) * motion.yaw + drift_rad_per_m * motion.x);
  }
};

}  // namespace mstsl
