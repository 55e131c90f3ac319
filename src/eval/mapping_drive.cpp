#include "mapping_drive.hpp"

#include <fmt/format.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/sim/drive.hpp"
#include "mstsl/sim/run.hpp"

namespace mstsl {
namespace {

constexpr std::uint64_t kTourStream = 2, kDriveStream = 3;

Result<sim::Route> tour(const sim::World& world, double length_m, const Random& random) {
  sim::RunOptions options;
  options.length_m = length_m;
  const auto start = sim::random_waypoint(world, options, random.fork(0));
  if (!start) return start.error();
  return sim::tour_from(world, *start, options, random);
}

Result<sim::RobotOptions> robot_named(const std::string& name) {
  sim::RobotOptions robot;
  if (name == "good") {
    robot.lidar.rate_hz = 10.0, robot.lidar.beams = 541;
    return robot;
  }
  if (name != "cheap") return Error(fmt::format("there is no robot '{}'; there are good and cheap", name));
  robot.lidar = {.rate_hz = 5.5,
                 .field_of_view_rad = radians(359.0),
                 .beams = 360,
                 .sweep_s = 0.18,
                 .range_max_m = 8.0,
                 .near_noise_m = 0.02};
  robot.odometry.scale_sigma = 0.06;
  robot.odometry.drift_sigma_rad_per_m = radians(2.0);
  return robot;
}

}  // namespace

Result<Recording> record_drive(const sim::World& world, const std::string& robot_name,
                               const MappingProtocolOptions& options, const Random& random) {
  const auto route = tour(world, options.length_m, random.fork(kTourStream));
  if (!route) return route.error();
  const Result<sim::RobotOptions> robot = robot_named(robot_name);
  if (!robot) return robot.error();
  Recording recording{.rig = robot->rig, .events = {}, .truth = {}};
  sim::drive(world, *robot, *route, Stamp{}, random.fork(kDriveStream),
             {[&](const SensorEvent& event) { recording.events.push_back(event); },
              [&](const PoseReading& pose) { recording.truth.add(pose.stamp, pose.map_T_base); }});
  return recording;
}

}  // namespace mstsl
