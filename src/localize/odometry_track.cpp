#include "mstsl/localize/odometry_track.hpp"

#include <algorithm>
#include <cmath>

namespace mstsl {

bool OdometryTrack::plausible(const Pose2& step, double seconds) const {
  const double time_s = std::max(seconds, options_.burst_s);  // stamps jitter: in less no speed can be told
  return std::hypot(step.x, step.y) <= options_.max_speed_m_s * time_s &&
         std::abs(step.yaw) <= options_.max_turn_rate_rad_s * time_s;
}

/// Whether a reading continues the motion so far. Within a burst it is held against the reading before it.
bool OdometryTrack::goes_on(const OdometryReading& reading) {
  const bool in_burst = before_burst_ && reading.stamp - last_->stamp <= options_.burst_s &&
                        last_->stamp - before_burst_->stamp > options_.burst_s;
  if (!in_burst) before_burst_ = last_;
  return chained_ && plausible(between(before_burst_->odom_T_base, reading.odom_T_base),
                               reading.stamp - before_burst_->stamp);
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
    const bool continued = goes_on({reading.stamp, pose});
    if (!continued && chained_ && reading.stamp == last_->stamp) {  // two poses at once: the first one counts
      ++dropped_;
      return;
    }
    if (!continued) {
      ++breaks_;
      before_burst_.reset();
    }
    const Pose2 moved = continued ? between(last_->odom_T_base, pose) : Pose2{};
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
  // The present speed, over more than a burst: within one it would be anything.
  const TimedPose& now = track_.back();
  std::size_t i = track_.size() - 1;
  while (i > 0 && now.stamp - track_[i].stamp <= options_.burst_s) --i;
  const double period_s = now.stamp - track_[i].stamp;
  if (period_s <= options_.burst_s || period_s > options_.max_extrapolation_s) return now.pose;
  return interpolate(track_[i].pose, now.pose, 1.0 + ahead_s / period_s);
}

}  // namespace mstsl
