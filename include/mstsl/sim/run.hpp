#pragma once

#include <Eigen/Core>

#include "mstsl/core/random.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/sim/route.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::sim {

/// A run to be localized: from anywhere on the lanes, heading anywhere, along corridors and aisles.
struct RunOptions {
  double length_m = 14.0;  ///< the paper calls a fix after more than 10 m a failure
  double lateral_m = 0.3;  ///< waypoints lie up to this far beside a lane's centre line
  PathOptions path;
};

/// A point of the driveable ground near a lane, drawn evenly over the lanes' length (the paper's waypoint).
Result<Eigen::Vector2d> random_waypoint(const World& world, const RunOptions& options, const Random& random);

/// A route of the wished length from a waypoint, with a random heading at the start. Errors: no lane is that
/// far away.
Result<Route> route_from(const World& world, const Eigen::Vector2d& waypoint_m, const RunOptions& options,
                         const Random& random);

/// On and on to random places (leg k's drawn by `random.fork(k)`, from 1), each on the shortest way, until
/// the route has the wished length; it sets out ahead. Errors: no other place can be reached.
Result<Route> tour_from(const World& world, const Eigen::Vector2d& waypoint_m, const RunOptions& options,
                        const Random& random);

/// A random waypoint and a route from there; a tour, where no single way is that long.
Result<Route> random_run(const World& world, const RunOptions& options, const Random& random);

}  // namespace mstsl::sim
