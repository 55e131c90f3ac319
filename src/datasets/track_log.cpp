#include "mstsl/datasets/track_log.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "mstsl/core/pose2.hpp"

namespace mstsl::datasets {
namespace {

struct Parts {
  TrackPart part;
  std::vector<OdometryReading> odometry;
  std::vector<LaserScan> scans;
  std::shared_ptr<const sim::World> world;
  Rig rig;
  sim::MagnetometerOptions magnetometer;
  Random random;
};

template <typename Reading>
std::vector<Reading> within(std::span<const Reading> readings, Stamp from, Stamp to) {
  std::vector<Reading> chosen;
  std::copy_if(readings.begin(), readings.end(), std::back_inserter(chosen),
               [&](const Reading& reading) { return reading.stamp >= from && reading.stamp <= to; });
  return chosen;
}

/// The recorded readings, and one between them at the time of each scan, as a driver of the usual 50 Hz would
/// give.
std::vector<OdometryReading> with_one_at_each(std::span<const LaserScan> scans,
                                              std::span<const OdometryReading> odometry, Stamp from,
                                              Stamp to) {
  std::vector<OdometryReading> readings = within(odometry, from, to);
  for (const LaserScan& scan : within(scans, from, to))
    if (const std::optional<Pose2> pose = odometry_at(odometry, scan.stamp))
      readings.push_back({scan.stamp, *pose});
  const auto earlier = [](const OdometryReading& a, const OdometryReading& b) { return a.stamp < b.stamp; };
  std::stable_sort(readings.begin(), readings.end(), earlier);
  const auto same = [](const OdometryReading& a, const OdometryReading& b) { return a.stamp == b.stamp; };
  readings.erase(std::unique(readings.begin(), readings.end(), same), readings.end());
  return readings;
}

/// How fast the wheels turn, by the way from one pose to the next, for the field of their motors.
struct WheelSpeeds {
  double left_m_s;
  double right_m_s;
};

WheelSpeeds wheel_speeds(const Pose2& motion, double seconds) {
  const double half_track_m = sim::OdometryOptions{}.wheel_base_m / 2.0;
  return {(motion.x - half_track_m * motion.yaw) / seconds, (motion.x + half_track_m * motion.yaw) / seconds};
}

std::vector<FieldReading> field_along(const Parts& parts) {
  sim::Magnetometer magnetometer(parts.magnetometer, parts.random);
  const double step_s = 1.0 / parts.magnetometer.rate_hz;
  std::vector<FieldReading> readings;
  for (std::int64_t i = 0;; ++i) {
    const Stamp stamp = parts.part.from + static_cast<double>(i) * step_s;
    if (stamp > parts.part.to) return readings;
    const Pose2 pose = parts.part.track->at(stamp);
    const WheelSpeeds wheels = wheel_speeds(between(pose, parts.part.track->at(stamp + step_s)), step_s);
    const Eigen::Isometry3d map_T_sensor = to_isometry3(pose) * parts.rig.base_T_magnetometer;
    const Eigen::Vector3d true_uT =
        map_T_sensor.linear().transpose() * parts.world->field_uT(map_T_sensor.translation());
    readings.push_back({stamp, magnetometer.read(true_uT, wheels.left_m_s, wheels.right_m_s, step_s)});
  }
}

void play(const Parts& parts, const sim::DriveSinks& sinks) {
  std::vector<SensorEvent> events(parts.odometry.begin(), parts.odometry.end());
  for (FieldReading& reading : field_along(parts)) events.emplace_back(reading);
  events.insert(events.end(), parts.scans.begin(), parts.scans.end());
  std::stable_sort(events.begin(), events.end(),
                   [](const SensorEvent& a, const SensorEvent& b) { return stamp_of(a) < stamp_of(b); });
  Stamp told{-1};
  for (const SensorEvent& event : events) {
    const Stamp stamp = stamp_of(event);
    if (sinks.truth && !std::holds_alternative<FieldReading>(event) && stamp != told) {
      sinks.truth({stamp, parts.part.track->at(stamp)});
      told = stamp;
    }
    if (sinks.event) sinks.event(event);
  }
}

}  // namespace

Log track_log(const TrackPart& part, std::span<const OdometryReading> odometry,
              std::span<const LaserScan> scans, std::shared_ptr<const sim::World> world, const Rig& rig,
              const sim::MagnetometerOptions& magnetometer, const Random& random) {
  const auto parts = std::make_shared<const Parts>(
      Parts{part, with_one_at_each(scans, odometry, part.from, part.to), within(scans, part.from, part.to),
            std::move(world), rig, magnetometer, random});
  return {rig, [parts](const sim::DriveSinks& sinks) { play(*parts, sinks); }};
}

}  // namespace mstsl::datasets
