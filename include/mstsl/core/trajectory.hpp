#pragma once

#include <deque>
#include <optional>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/stamp.hpp"

namespace mstsl {

/// A pose and when it held. The frames are those of whoever keeps it.
struct TimedPose {
  Stamp stamp;
  Pose2 pose;
};

/// Poses of one thing at increasing times, to be asked for the times between.
class Trajectory {
 public:
  /// Appends a pose. False, and nothing appended, if it is not finite or not later than the last one.
  bool add(Stamp stamp, const Pose2& pose);

  /// Another pose in place of the last one, which there must be. Expects a finite pose.
  void replace_last(const Pose2& pose) { poses_.back().pose = pose; }

  /// Drops the poses before the last one that is no later than `stamp`, so that `at(stamp)` stays answered.
  void forget_before(Stamp stamp);

  bool empty() const { return poses_.empty(); }
  std::size_t size() const { return poses_.size(); }
  const TimedPose& operator[](std::size_t i) const { return poses_[i]; }
  const TimedPose& front() const { return poses_.front(); }
  const TimedPose& back() const { return poses_.back(); }

  /// The pose at a time, between its neighbours; nothing outside the time covered, nor inside a gap longer
  /// than `max_gap_s`.
  std::optional<Pose2> at(Stamp stamp, double max_gap_s) const;

 private:
  std::deque<TimedPose> poses_;
};

}  // namespace mstsl
