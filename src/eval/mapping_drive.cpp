#include "mapping_drive.hpp"

#include <cmath>

#include <fmt/format.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/sim/drive.hpp"
#include "mstsl/sim/run.hpp"

namespace mstsl {
namespace {

constexpr std::uint64_t kTourStream = 2, kDriveStream = 3;

/// From place to place, each drawn by chance, on the shortest ways.
Result<sim::Route> tour(const sim::World& world, double length_m, const Random& random) {
  sim::Route route;
  auto at = sim::random_waypoint(world, {}, random.fork(0));
  if (!at) return at.error();
  route.waypoints_m.push_back(*at);
  for (std::uint64_t k = 1; sim::length(route) < length_m; ++k) {
    const auto to = sim::random_waypoint(world, {}, random.fork(k));
    if (!to) return to.error();
    const auto way = sim::plan_path(world, route.waypoints_m.back(), *to);
    if (!way) return way.error();
    route.waypoints_m.insert(route.waypoints_m.end(), way->begin() + 1, way->end());
  }
  const Eigen::Vector2d first = route.waypoints_m[1] - route.waypoints_m[0];
  route.start_yaw_rad = std::atan2(first.y(), first.x());
  return sim::truncated(route, length_m);
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
