#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "mstsl/core/sensor_data.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/localize/odometry_track.hpp"
#include "mstsl/mapping/thinned_track.hpp"

namespace mstsl {

/// A scan, and where odometry has the robot at its first beam and at its last.
struct PlacedScan {
  LaserScan scan;
  Pose2 track_T_base;
  Pose2 track_T_end;
};

/// The odometry of a drive, and its scans, which wait for the odometry around them. Feed it in time order.
class ScanQueue {
 public:
  void observe(const OdometryReading& odometry);
  void observe(const OdometryRestart& restart) { track_.restart(restart); }
  void observe(const LaserScan& scan);

  /// The next scan whose odometry has come, or, at the end, may be guessed; scans of times without any are
  /// left out.
  std::optional<PlacedScan> next(bool at_the_end);

  const OdometryTrack& track() const { return track_; }
  /// track_T_base so far, as ThinnedTrack keeps it.
  const std::vector<TimedPose>& odometry() const { return odometry_.poses(); }
  std::size_t scans_seen() const { return scans_seen_; }

 private:
  OdometryTrack track_;
  ThinnedTrack odometry_;
  std::deque<LaserScan> waiting_;
  std::size_t scans_seen_ = 0;
};

}  // namespace mstsl
