#include "mstsl/mapping/thinned_track.hpp"

#include <algorithm>
#include <cmath>

#include "mstsl/core/angles.hpp"

namespace mstsl {

void ThinnedTrack::add(const TimedPose& at) {
  if (!poses_.empty() && at.stamp <= poses_.back().stamp) return;
  if (poses_.size() >= 2) {
    left_out_.push_back(poses_.back());
    if (lie_between(poses_[poses_.size() - 2], at))
      poses_.pop_back();
    else
      left_out_.clear();
  }
  poses_.push_back(at);
}

bool ThinnedTrack::lie_between(const TimedPose& from, const TimedPose& to) const {
  constexpr double kLongest_s = 0.25, kNear_m = 1e-3;
  const double kNear_rad = radians(0.03);
  const double whole_s = to.stamp - from.stamp;
  if (whole_s > kLongest_s) return false;
  return std::all_of(left_out_.begin(), left_out_.end(), [&](const TimedPose& at) {
    const Pose2 between = interpolate(from.pose, to.pose, (at.stamp - from.stamp) / whole_s);
    return distance(between, at.pose) < kNear_m &&
           std::abs(angle_between(between.yaw, at.pose.yaw)) < kNear_rad;
  });
}

}  // namespace mstsl
