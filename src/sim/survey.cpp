#include "mstsl/sim/survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;

/// The parallel lines of a lane, from one edge to the other, `spacing_m` apart and centred.
std::vector<Segment> lines_of(const Lane& lane, double spacing_m, double margin_m) {
  const double usable_m = std::max(0.0, lane.free_width_m - 2.0 * margin_m);
  const int gaps = static_cast<int>(usable_m / spacing_m + 1e-9);
  const Vector2d ahead = (lane.center.b - lane.center.a).normalized(), aside(-ahead.y(), ahead.x());
  std::vector<Segment> lines;
  for (int i = 0; i <= gaps; ++i) {
    const Vector2d shift = (i - 0.5 * gaps) * spacing_m * aside;
    lines.push_back({lane.center.a + shift, lane.center.b + shift});
  }
  return lines;
}

double clearance_at(const World& world, const Vector2d& point_m) {
  const Cell cell = world.clearance_m().geometry().cell_at(point_m);
  return world.clearance_m().contains(cell) ? world.clearance_m()[cell] : 0.0;
}

/// The parts of a line that a robot can drive: a parked car or a cupboard may stand in its way.
std::vector<Segment> drivable_parts(const World& world, const Segment& line, double clearance_m) {
  constexpr double kStep_m = 0.05, kShortest_m = 1.0;
  const int steps = std::max(1, static_cast<int>(length(line) / kStep_m));
  std::vector<Segment> parts;
  int first = -1;
  for (int i = 0; i <= steps + 1; ++i) {
    const bool free =
        i <= steps && clearance_at(world, point_along(line, static_cast<double>(i) / steps)) >= clearance_m;
    if (free && first < 0) first = i;
    if (!free && first >= 0) {
      const Segment part{point_along(line, static_cast<double>(first) / steps),
                         point_along(line, static_cast<double>(i - 1) / steps)};
      if (length(part) >= kShortest_m) parts.push_back(part);
      first = -1;
    }
  }
  return parts;
}

std::vector<Segment> all_lines(const World& world, double spacing_m, double margin_m, double clearance_m) {
  std::vector<Segment> lines;
  for (const Lane& lane : world.lanes())
    for (const Segment& line : lines_of(lane, spacing_m, margin_m))
      for (const Segment& part : drivable_parts(world, line, clearance_m)) lines.push_back(part);
  return lines;
}

/// The lines in an order without long ways between them: always on to the nearest that is left.
std::vector<Segment> ordered(std::vector<Segment> lines) {
  std::vector<Segment> order;
  Vector2d at = lines.empty() ? Vector2d::Zero() : lines.front().a;
  while (!lines.empty()) {
    const auto away = [&](const Segment& line) {
      return std::min((line.a - at).squaredNorm(), (line.b - at).squaredNorm());
    };
    const auto nearest = std::min_element(
        lines.begin(), lines.end(), [&](const Segment& p, const Segment& q) { return away(p) < away(q); });
    Segment line = *nearest;
    lines.erase(nearest);
    if ((line.b - at).squaredNorm() < (line.a - at).squaredNorm()) std::swap(line.a, line.b);
    order.push_back(line);
    at = line.a;  // each is driven there and back
  }
  return order;
}

/// Appends the way to a point, planned around obstacles.
Result<void> go_to(const World& world, Route& route, const Vector2d& goal_m, const PathOptions& path) {
  if (route.waypoints_m.empty()) {
    route.waypoints_m.push_back(goal_m);
    return {};
  }
  const auto way = plan_path(world, route.waypoints_m.back(), goal_m, path);
  if (!way)
    return way.error().within("the survey of world '" + world.name() + "' cannot go from lane to lane");
  route.waypoints_m.insert(route.waypoints_m.end(), way->begin() + 1, way->end());
  return {};
}

double total_length(const std::vector<Route>& routes) {
  double sum = 0.0;
  for (const Route& route : routes) sum += length(route);
  return sum;
}

double direction(const Segment& line) { return std::atan2(line.b.y() - line.a.y(), line.b.x() - line.a.x()); }

/// Drives lines there and back, one after the other, until all logs together are `wanted_m` long.
Result<void> drive_lines(const World& world, const std::vector<Segment>& lines, const SurveyOptions& options,
                         double wanted_m, std::vector<Route>& routes) {
  double driven_m = total_length(routes);
  for (const Segment& line : lines) {
    if (driven_m >= wanted_m) break;
    if (routes.empty() || length(routes.back()) >= options.log_length_m)
      routes.push_back({direction(line), {}});
    Route& route = routes.back();
    const double before_m = length(route);
    if (const auto went = go_to(world, route, line.a, options.path); !went) return went.error();
    // Straight, not planned: a planner would leave a line near a wall or through a door for an easier way.
    route.waypoints_m.insert(route.waypoints_m.end(), {line.b, line.a});
    driven_m += length(route) - before_m;
  }
  return {};
}

std::vector<Segment> ordered_lines(const World& world, const SurveyOptions& options, double spacing_m) {
  return ordered(all_lines(world, spacing_m, options.edge_margin_m, options.path.clearance_m));
}

/// One pass over all lines; where that is longer than wished, over fewer lines.
Result<std::vector<Segment>> lines_for(const World& world, const SurveyOptions& options, double wanted_m) {
  constexpr double kWidest_m = 20.0, kSparser = 1.2;
  for (double spacing_m = options.lane_spacing_m; spacing_m < kWidest_m; spacing_m *= kSparser) {
    std::vector<Segment> lines = ordered_lines(world, options, spacing_m);
    if (lines.empty()) return Error("world '" + world.name() + "' has no lane that a robot can drive on");
    double both_ways_m = 0.0;
    for (const Segment& line : lines) both_ways_m += 2.0 * length(line);
    if (both_ways_m <= wanted_m) return lines;
  }
  return Error("so few fingerprints do not reach along every lane of world '" + world.name() +
               "'; ask for more, or for none to take one pass");
}

}  // namespace

Result<std::vector<Route>> survey_routes(const World& world, const SurveyOptions& options) {
  if (!(options.lane_spacing_m > 0) || !(options.fingerprint_spacing_m > 0) || options.passes < 1)
    return Error("a survey needs spacings above 0 m and at least one pass");
  const bool counted = options.fingerprints > 0;
  const double wanted_m = counted ? static_cast<double>(options.fingerprints) * options.fingerprint_spacing_m
                                  : std::numeric_limits<double>::infinity();
  const auto lines = lines_for(world, options, wanted_m);
  if (!lines) return lines.error();
  std::vector<Route> routes;
  for (int pass = 0; counted ? total_length(routes) < wanted_m : pass < options.passes; ++pass)
    if (const auto drove = drive_lines(world, *lines, options, wanted_m, routes); !drove)
      return drove.error();
  if (const double excess_m = total_length(routes) - wanted_m; excess_m > 0)
    routes.back() = truncated(routes.back(), length(routes.back()) - excess_m);
  return routes;
}

}  // namespace mstsl::sim
