#pragma once

#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/io/recording.hpp"

/// The drive that other people's programs write for us and read from us: 200 steps at 8 Hz, each with one
/// message of every kind. Its values are exact in binary, so that they can be compared for equality. The same
/// values stand in write_bags.py, write_mcaps.mjs and read_mcap.mjs.
namespace mstsl::test {

inline constexpr int kSteps = 200;
inline constexpr int kBeams = 25;
inline constexpr double kYaw_rad =
    1.2870022175865687;  ///< of the quaternion z = 0.6, w = 0.8: 2 atan2(0.6, 0.8)

inline Stamp reference_stamp(int step) { return {1'000'000'000'000 + 125'000'000LL * step}; }

inline Rig reference_rig() {
  const Eigen::AngleAxisd turn(kYaw_rad, Eigen::Vector3d::UnitZ());
  Rig rig;
  rig.base_T_laser = Eigen::Translation3d(0.25, 0.0, 0.5) * turn * Eigen::Translation3d(0.0, 0.125, 0.0);
  // Given as imu_T_base: a half turn about x, one metre down.
  rig.base_T_magnetometer =
      (Eigen::Translation3d(0.0, 0.0, -1.0) * Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX())).inverse();
  return rig;
}

inline io::Topics reference_topics() {
  io::Topics topics;
  topics.pose = "/ground_truth";
  return topics;
}

inline std::vector<SensorEvent> reference_events() {
  std::vector<SensorEvent> events;
  for (int i = 0; i < kSteps; ++i) {
    const Stamp stamp = reference_stamp(i);
    events.push_back(OdometryReading{stamp, {0.125 * i, -0.0625 * i, kYaw_rad}});
    events.push_back(FieldReading{stamp, {20.0, 1e-3 * i, -40.0}});
    events.push_back(ImuReading{stamp, {0.5, -0.25, 0.125 * i}, Eigen::Quaterniond(0.8, 0.0, 0.0, 0.6)});
    events.push_back(PoseReading{stamp, {10.0 + 0.125 * i, 5.0, 0.0}});
    LaserScan scan{stamp, 1.5, -0.125, 0.0009765625, 0.125, 30.0, {}};
    for (int beam = 0; beam < kBeams; ++beam)
      scan.ranges_m.push_back(static_cast<float>(1.0 + (i + beam) / 64.0));
    events.push_back(scan);
  }
  return events;
}

}  // namespace mstsl::test
