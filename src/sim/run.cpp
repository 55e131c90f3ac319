#include "mstsl/sim/run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "mstsl/core/angles.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;

enum RunStream : std::uint64_t { kWaypoint = 1, kRoute = 2, kTour = 3 };
constexpr int kTries = 200;

bool is_roomy(const World& world, const Vector2d& point_m, double clearance_m) {
  const Grid<float>& clearance = world.clearance_m();
  const Cell cell = clearance.geometry().cell_at(point_m);
  return clearance.contains(cell) && clearance[cell] >= clearance_m;
}

/// A point beside a lane's centre line, the lane drawn by its length.
Vector2d point_by_lanes(const World& world, double lateral_m, Random& random) {
  double whole_m = 0.0;
  for (const Lane& lane : world.lanes()) whole_m += length(lane.center);
  double along_m = random.uniform(0.0, whole_m);
  const double beside_m = random.uniform(-lateral_m, lateral_m);
  for (const Lane& lane : world.lanes()) {
    const double lane_m = length(lane.center);
    if (along_m <= lane_m && lane_m > 0) {
      const Vector2d ahead = (lane.center.b - lane.center.a) / lane_m;
      return point_along(lane.center, along_m / lane_m) + beside_m * Vector2d(-ahead.y(), ahead.x());
    }
    along_m -= lane_m;
  }
  return world.lanes().back().center.b;
}

}  // namespace

Result<Vector2d> random_waypoint(const World& world, const RunOptions& options, const Random& random) {
  Random own = random;
  for (int i = 0; i < kTries && !world.lanes().empty(); ++i) {
    const Vector2d point = point_by_lanes(world, options.lateral_m, own);
    if (is_roomy(world, point, options.path.clearance_m)) return point;
  }
  return Error("world '" + world.name() + "' has no lane with " + std::to_string(options.path.clearance_m) +
               " m of room around the robot; lower the clearance");
}

Result<Route> route_from(const World& world, const Vector2d& waypoint_m, const RunOptions& options,
                         const Random& random) {
  Random own = random;
  const double start_yaw = own.uniform(-kPi, kPi);
  for (int i = 0; i < kTries && !world.lanes().empty(); ++i) {
    const Vector2d goal = point_by_lanes(world, options.lateral_m, own);
    // Nearer than this even a crooked way is seldom long enough; planning to it would be in vain.
    if ((goal - waypoint_m).norm() < 0.5 * options.length_m ||
        !is_roomy(world, goal, options.path.clearance_m))
      continue;
    const auto path = plan_path(world, waypoint_m, goal, options.path);
    if (!path) continue;
    const Route whole{start_yaw, *path};
    if (length(whole) >= options.length_m) return truncated(whole, options.length_m);
  }
  return Error("no route of " + std::to_string(options.length_m) + " m starts at (" +
               std::to_string(waypoint_m.x()) + ", " + std::to_string(waypoint_m.y()) + ") in world '" +
               world.name() + "'; ask for a shorter run");
}

Result<Route> tour_from(const World& world, const Vector2d& waypoint_m, const RunOptions& options,
                        const Random& random) {
  Route route{0.0, {waypoint_m}};
  double length_m = 0.0;
  int in_vain = 0;
  for (std::uint64_t leg = 1; length_m < options.length_m; ++leg) {
    const auto goal = random_waypoint(world, options, random.fork(leg));
    if (!goal) return goal.error();
    const auto way = plan_path(world, route.waypoints_m.back(), *goal, options.path);
    const double way_m = way ? length(Route{0.0, *way}) : 0.0;
    constexpr double kSomewhere_m = 0.1;
    if (way_m < kSomewhere_m) {
      if (++in_vain < kTries) continue;
      return Error("in world '" + world.name() + "' no way leads on from (" +
                   std::to_string(route.waypoints_m.back().x()) + ", " +
                   std::to_string(route.waypoints_m.back().y()) + ")");
    }
    in_vain = 0, length_m += way_m;
    route.waypoints_m.insert(route.waypoints_m.end(), way->begin() + 1, way->end());
  }
  if (route.waypoints_m.size() > 1) {
    const Vector2d ahead = route.waypoints_m[1] - route.waypoints_m[0];
    route.start_yaw_rad = std::atan2(ahead.y(), ahead.x());
  }
  return truncated(route, options.length_m);
}

Result<Route> random_run(const World& world, const RunOptions& options, const Random& random) {
  const auto waypoint = random_waypoint(world, options, random.fork(kWaypoint));
  if (!waypoint) return waypoint.error();
  const auto route = route_from(world, *waypoint, options, random.fork(kRoute));
  if (route) return route;
  auto tour = tour_from(world, *waypoint, options, random.fork(kTour));
  if (tour) tour->start_yaw_rad = random.fork(kRoute).uniform(-kPi, kPi);
  return tour;
}

}  // namespace mstsl::sim
