#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/core/stamp.hpp"

namespace mstsl::datasets {

/// odom_T_base at a time, between the readings (which are in time order); nothing outside them.
std::optional<Pose2> odometry_at(std::span<const OdometryReading> odometry, Stamp stamp);

/// A robot's way through the poses that somebody's SLAM gave it now and then: between two of them it has the
/// shape that odometry recorded, pulled evenly in time so that it meets both.
class CorrectedTrack {
 public:
  /// Both in time order, and one corrected pose at least. Odometry need not reach all of them: where there is
  /// none the way is straight.
  CorrectedTrack(std::span<const PoseReading> corrected, std::span<const OdometryReading> odometry);

  Stamp first() const { return knots_.front().stamp; }
  Stamp last() const { return knots_.back().stamp; }

  /// The pose at a time; before the first and after the last corrected pose it is that one.
  Pose2 at(Stamp stamp) const;

 private:
  std::vector<PoseReading> knots_;
};

}  // namespace mstsl::datasets
