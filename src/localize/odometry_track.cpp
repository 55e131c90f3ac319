#include "mstsl/localize/odometry_track.hpp"

#include <algorithm>
#include <cmath>

namespace mstsl {

bool OdometryTrack::plausible(const Pose2& step, double seconds) const {
  // Stamps jitter, and drivers that were held up hand on several readings in a burst: within a tenth of a
  // second hardly any speed can be told.
  const double time_s = std::max(seconds, 0.1);
  return std::hypot(step.x, step.y) <= options_.max_speed_m_s * time_s &&
         std::abs(step.yaw) <= options_.max_turn_rate_rad_s * time_s;
}

void OdometryTrack::add(const OdometryReading& reading) {
  const Pose2 pose = Pose2::from(reading.odom_T_base.position(), reading.odom_T_base.yaw);
  if (!pose.is_finite() || (last_ && reading.stamp < last_->stamp)) {
    ++dropped_;
    return;
  }
  if (!last_) {
    track_.add(reading.stamp, pose);
  } else {
    const Pose2 step = between(last_->odom_T_base, pose);
    const bool goes_on = chained_ && plausible(step, reading.stamp - last_->stamp);
    if (!goes_on) ++breaks_;
    const Pose2 moved = goes_on ? step : Pose2{};
    travelled_m_ += std::hypot(moved.x, moved.y);
    const Pose2 now = track_.back().pose * moved;
    if (!track_.add(reading.stamp, now)) track_.replace_last(now);  // several readings of one stamp
    track_.forget_before(reading.stamp + -options_.memory_s);
  }
  last_ = OdometryReading{reading.stamp, pose};
  chained_ = true;
}

std::optional<Pose2> OdometryTrack::at(Stamp stamp) const {
  if (track_.empty()) return std::nullopt;
  const double ahead_s = stamp - track_.back().stamp;
  if (ahead_s <= 0.0) return track_.at(stamp, options_.memory_s);
  if (ahead_s > options_.max_extrapolation_s) return std::nullopt;
  if (track_.size() < 2) return track_.back().pose;
  const TimedPose& before = track_[track_.size() - 2];
  const double period_s = track_.back().stamp - before.stamp;
  if (period_s > options_.max_extrapolation_s)
    return track_.back().pose;  // too long ago to tell the present speed
  return interpolate(before.pose, track_.back().pose, 1.0 + ahead_s / period_s);
}

}  // namespace mstsl
