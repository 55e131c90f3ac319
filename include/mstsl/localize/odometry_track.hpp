#pragma once

#include <cstdint>
#include <optional>

#include "mstsl/core/sensor_data.hpp"
#include "mstsl/core/trajectory.hpp"

namespace mstsl {

struct OdometryTrackOptions {
  /// Faster than this, in m/s, two readings do not belong together (a reset driver): twice what the fastest
  /// indoor platforms drive.
  double max_speed_m_s = 5.0;
  /// The same for turning, in rad/s; one and a half turns a second.
  double max_turn_rate_rad_s = 9.4;
  /// Readings no further apart than this, in s, came in one burst: a driver or network held them up and let
  /// them go together (the CARMEN logs of 2003 do so ten times a minute). Their own stamps tell no speed; the
  /// time since the last reading before the burst does.
  double burst_s = 0.02;
  /// A reading asked for later than the last one by more than this, in s, is not extrapolated to; ten periods
  /// of a slow (10 Hz) driver would be 1 s, but at walking pace 0.3 s are already half a metre.
  double max_extrapolation_s = 0.3;
  /// How much of the past can be asked for, in s: longer than any sensor's delay.
  double memory_s = 5.0;
};

/// The wheel odometry of a whole log as one continuous motion, whatever the driver does: a restart or an
/// implausible jump breaks the chain, which then goes on from where it was. Frame `track`: the first
/// reading's `odom`, continued.
class OdometryTrack {
 public:
  explicit OdometryTrack(const OdometryTrackOptions& options = {}) : options_(options) {}

  void add(const OdometryReading& reading);
  void restart(const OdometryRestart&) { chained_ = false; }

  /// track_T_base at a time: between readings, or extrapolated with the last motion for a moment; nothing
  /// otherwise.
  std::optional<Pose2> at(Stamp stamp) const;

  /// Whether `stamp` lies no later than the last reading, so that at() need not extrapolate.
  bool covers(Stamp stamp) const { return !track_.empty() && stamp <= track_.back().stamp; }

  /// The path length so far, in m. Breaks add nothing.
  double travelled_m() const { return travelled_m_; }
  /// How often the chain was broken: motion over a break is unknown.
  std::uint64_t breaks() const { return breaks_; }
  /// Readings that were dropped: not finite, or earlier than the last one.
  std::uint64_t dropped() const { return dropped_; }

 private:
  bool plausible(const Pose2& step, double seconds) const;
  bool goes_on(const OdometryReading& reading);

  OdometryTrackOptions options_;
  Trajectory track_;
  std::optional<OdometryReading> last_;
  std::optional<OdometryReading>
      before_burst_;  ///< the last reading before the burst that `last_` belongs to
  bool chained_ = true;
  double travelled_m_ = 0.0;
  std::uint64_t breaks_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace mstsl
