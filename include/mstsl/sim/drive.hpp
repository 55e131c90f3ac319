#pragma once

#include <functional>

#include <Eigen/Core>

#include "mstsl/core/random.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/sim/robot.hpp"
#include "mstsl/sim/trajectory.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::sim {

/// The true field at a place, map frame, uT; the robot's pose is given for fields that are known along a path
/// only.
using FieldSource =
    std::function<Eigen::Vector3d(const Pose2& map_T_base, const Eigen::Vector3d& position_m)>;

/// Where the sensors' events and, apart from them, the truth go. Either may be empty.
struct DriveSinks {
  std::function<void(const SensorEvent&)> event;
  std::function<void(const PoseReading&)> truth;  ///< at the odometry's stamps, just before its event
};

/// Moves a robot along a trajectory and reports what its sensors say, in time order. The magnetometer reads
/// `field`, by default the world's steel. Every sensor has its own fork of `random`: switching one off
/// changes no other.
void drive(const World& world, const RobotOptions& robot, const Trajectory& trajectory, const Random& random,
           const DriveSinks& sinks, const FieldSource& field = {});

/// The same along a route, as `follow` drives it with the robot's motion options.
void drive(const World& world, const RobotOptions& robot, const Route& route, Stamp start,
           const Random& random, const DriveSinks& sinks, const FieldSource& field = {});

/// The first scan of the drive that the same arguments give, taken while the robot still stands: what it sees
/// before it is told to turn.
LaserScan first_scan(const World& world, const RobotOptions& robot, const Route& route, Stamp start,
                     const Random& random);

}  // namespace mstsl::sim
