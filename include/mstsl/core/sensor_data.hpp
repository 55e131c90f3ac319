#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/stamp.hpp"

/// What a robot measures, in SI units and microtesla, free of any file format. Readers and the simulator make
/// these; the estimators consume them.
namespace mstsl {

/// Wheel odometry: the pose of base_link in the drifting but continuous frame `odom`.
struct OdometryReading {
  Stamp stamp;
  Pose2 odom_T_base;
};

/// Odometry starts anew (another file, a driver's restart): the next reading says nothing about the last.
struct OdometryRestart {
  Stamp stamp;
};

/// A planar scan in the frame `laser`: beam i points to angle_min_rad + i * angle_increment_rad and is taken
/// at stamp + i * time_increment_s. A range that is not finite or outside [range_min_m, range_max_m] is no
/// return.
struct LaserScan {
  Stamp stamp;
  double angle_min_rad = 0.0;
  double angle_increment_rad = 0.0;
  double time_increment_s = 0.0;
  double range_min_m = 0.0;
  double range_max_m = 0.0;
  std::vector<float> ranges_m;
};

/// The magnetic flux density in the sensor's own frame (`imu_link`), bias included.
struct FieldReading {
  Stamp stamp;
  Eigen::Vector3d sensor_field_uT = Eigen::Vector3d::Zero();
};

/// Rates, and the attitude where the driver gives one, of the inertial unit in `imu_link`.
struct ImuReading {
  Stamp stamp;
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  std::optional<Eigen::Quaterniond> world_q_sensor;
};

/// A known pose of base_link in the map: ground truth or a tracked survey, never an input of a localizer.
struct PoseReading {
  Stamp stamp;
  Pose2 map_T_base;
};

using SensorEvent =
    std::variant<OdometryReading, OdometryRestart, LaserScan, FieldReading, ImuReading, PoseReading>;

inline Stamp stamp_of(const SensorEvent& event) {
  return std::visit([](const auto& reading) { return reading.stamp; }, event);
}

/// Where the sensors sit on the robot, from /tf_static. Full rotations: a tilted magnetometer is normal.
struct Rig {
  Eigen::Isometry3d base_T_laser = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d base_T_magnetometer = Eigen::Isometry3d::Identity();
};

}  // namespace mstsl
