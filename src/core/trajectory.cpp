#include "mstsl/core/trajectory.hpp"

#include <algorithm>

namespace mstsl {
namespace {

bool earlier(Stamp stamp, const TimedPose& timed) { return stamp < timed.stamp; }

}  // namespace

bool Trajectory::add(Stamp stamp, const Pose2& pose) {
  if (!pose.is_finite() || (!poses_.empty() && stamp <= poses_.back().stamp)) return false;
  poses_.push_back({stamp, pose});
  return true;
}

void Trajectory::forget_before(Stamp stamp) {
  const auto later = std::upper_bound(poses_.begin(), poses_.end(), stamp, earlier);
  if (later - poses_.begin() > 1) poses_.erase(poses_.begin(), later - 1);
}

std::optional<Pose2> Trajectory::at(Stamp stamp, double max_gap_s) const {
  const auto after = std::upper_bound(poses_.begin(), poses_.end(), stamp, earlier);
  if (after == poses_.begin()) return std::nullopt;
  const TimedPose& before = *(after - 1);
  if (before.stamp == stamp) return before.pose;
  if (after == poses_.end()) return std::nullopt;
  const double gap_s = after->stamp - before.stamp;
  if (gap_s > max_gap_s) return std::nullopt;
  return interpolate(before.pose, after->pose, (stamp - before.stamp) / gap_s);
}

}  // namespace mstsl
