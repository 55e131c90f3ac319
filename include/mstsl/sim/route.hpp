#pragma once

#include <vector>

#include <Eigen/Core>

#include "mstsl/core/random.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::sim {

/// Where a robot is told to go: through the waypoints in straight lines, map frame, m.
struct Route {
  double start_yaw_rad = 0.0;  ///< heading before it sets out
  std::vector<Eigen::Vector2d> waypoints_m;
};

double length(const Route& route);

/// The first `length_m` of a route (all of it, if it is shorter).
Route truncated(const Route& route, double length_m);

struct PathOptions {
  double clearance_m = World::kRobotClearance_m;  ///< least distance of the robot's centre to any surface
  double preferred_clearance_m = 0.9;             ///< nearer than this the path prefers to keep away
};

/// A drivable way from one point to another: A* on the world's clearance grid, then straightened.
/// Errors: an end that is not on driveable ground, or no way between.
Result<std::vector<Eigen::Vector2d>> plan_path(const World& world, const Eigen::Vector2d& start_m,
                                               const Eigen::Vector2d& goal_m,
                                               const PathOptions& options = {});

}  // namespace mstsl::sim
