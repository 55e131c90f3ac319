#include "mstsl/sim/survey.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "mstsl/sim/trajectory.hpp"

#include "test_support.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;
using test::must;

double total(const std::vector<Route>& routes) {
  double sum = 0.0;
  for (const Route& route : routes) sum += length(route);
  return sum;
}

/// One sample for each 5 cm of true travel, as the mapping counts them.
double fingerprints(const std::vector<Route>& routes) {
  double count = 0.0;
  for (const Route& route : routes) count += std::floor(length(follow(route, {}, {}, Random(1))) / 0.05);
  return count;
}

TEST(Survey, ReachesThePapersNumbersOfFingerprints) {
  for (const auto& [name, wanted] :
       {std::pair("corridor", std::size_t{67238}), std::pair("carpark", std::size_t{118688})}) {
    SurveyOptions options;
    options.fingerprints = wanted;
    const auto routes = must(survey_routes(must(make_world(name, {}, Random(1))), options));
    EXPECT_NEAR(total(routes), 0.05 * static_cast<double>(wanted), 0.01) << name;
    EXPECT_NEAR(fingerprints(routes), static_cast<double>(wanted), 0.03 * static_cast<double>(wanted))
        << name;
  }
}

bool is_clear(const World& world, const Segment& line, double clearance_m) {
  for (double share = 0.0; share <= 1.0; share += 0.01) {
    const Cell cell = world.clearance_m().geometry().cell_at(point_along(line, share));
    if (!world.clearance_m().contains(cell) || world.clearance_m()[cell] < clearance_m) return false;
  }
  return true;
}

TEST(Survey, DrivesEachFreeLaneBothWays) {
  for (const std::string& name : world_names()) {
    const World world = must(make_world(name, {}, Random(1)));
    const auto routes = must(survey_routes(world, {}));
    for (const Lane& lane : world.lanes()) {
      if (!is_clear(world, lane.center, SurveyOptions{}.path.clearance_m))
        continue;  // a cupboard stands there
      const Vector2d ahead = (lane.center.b - lane.center.a).normalized();
      double forth_m = 0.0, back_m = 0.0;
      for (const Route& route : routes)
        for (const Segment& leg : polyline(route.waypoints_m, false)) {
          const double along = (leg.b - leg.a).dot(ahead);
          if (std::abs(along) < 0.999 * length(leg) ||
              distance(point_along(leg, 0.5), lane.center) > 0.5 * lane.free_width_m)
            continue;
          (along > 0 ? forth_m : back_m) += length(leg);
        }
      EXPECT_GT(forth_m, 0.8 * length(lane.center)) << name;
      EXPECT_GT(back_m, 0.8 * length(lane.center)) << name;
    }
  }
}

/// The share of a world's lanes' free width, sampled, that lies within `reach_m` of the survey's way.
double covered_share(const World& world, const std::vector<Route>& routes, double margin_m, double reach_m) {
  int free = 0, covered = 0;
  for (const Lane& lane : world.lanes()) {
    const Vector2d ahead = (lane.center.b - lane.center.a).normalized(), aside(-ahead.y(), ahead.x());
    const double half_m = 0.5 * lane.free_width_m - margin_m;
    for (double share = 0.02; share < 1.0; share += 0.04)
      for (double beside_m = -half_m; beside_m <= half_m; beside_m += 0.1) {
        const Vector2d point = point_along(lane.center, share) + beside_m * aside;
        if (world.surfaces().clearance(point, 1.0) < margin_m) continue;
        double away_m = 1e9;
        for (const Route& route : routes)
          for (const Segment& leg : polyline(route.waypoints_m, false))
            away_m = std::min(away_m, distance(point, leg));
        ++free;
        covered += away_m <= reach_m;
      }
  }
  return static_cast<double>(covered) / free;
}

TEST(Survey, LeavesNoStripOfALaneOut) {
  // The lines along the walls are driven as they are, not drawn to the middle by a planner that likes room.
  const SurveyOptions options;
  const double reach_m = 0.5 * options.lane_spacing_m + 0.05;
  for (const std::string& name : world_names()) {
    const World world = must(make_world(name, {}, Random(2)));
    const auto routes = must(survey_routes(world, options));
    EXPECT_GT(covered_share(world, routes, options.edge_margin_m, reach_m), 0.97) << name;
  }
}

TEST(Survey, PassesEveryLane) {
  const World world = must(make_world("office-wing", {}, Random(3)));
  const auto routes = must(survey_routes(world, {}));
  for (const Lane& lane : world.lanes())
    for (const double t : {0.1, 0.5, 0.9}) {
      double away = 1e9;
      for (const Route& route : routes)
        for (const Segment& leg : polyline(route.waypoints_m, false))
          away = std::min(away, distance(point_along(lane.center, t), leg));
      EXPECT_LT(away, 0.3);
    }
}

TEST(Survey, KeepsClearOfTheWalls) {
  for (const std::string& name : world_names()) {
    const World world = must(make_world(name, {}, Random(1)));
    for (const Route& route : must(survey_routes(world, {})))
      for (const Segment& leg : polyline(route.waypoints_m, false))
        for (double t = 0; t <= 1; t += 0.02)
          ASSERT_GT(world.surfaces().clearance(point_along(leg, t), 1.0), 0.2) << name;
  }
}

TEST(Survey, GrowsWithPassesAndShrinksWithSpacing) {
  const World world = must(make_world("corridor", {}, Random(1)));
  SurveyOptions twice, sparse;
  twice.passes = 2;
  sparse.lane_spacing_m = 2.0;
  const double once = total(must(survey_routes(world, {})));
  EXPECT_NEAR(total(must(survey_routes(world, twice))) / once, 2.0, 0.1);
  EXPECT_LT(total(must(survey_routes(world, sparse))), 0.5 * once);
}

TEST(Survey, IsCutIntoLogs) {
  const World world = must(make_world("carpark", {}, Random(1)));
  SurveyOptions options;
  options.log_length_m = 500;
  const auto routes = must(survey_routes(world, options));
  EXPECT_GT(routes.size(), 4u);
  for (const Route& route : routes) EXPECT_LT(length(route), 500 + 3 * 80);
}

TEST(Survey, RefusesImpossibleWishes) {
  const World world = must(make_world("corridor", {}, Random(1)));
  SurveyOptions few, none;
  few.fingerprints = 100;
  const auto routes = survey_routes(world, few);
  ASSERT_FALSE(routes);
  EXPECT_NE(routes.error().message().find("ask for more"), std::string::npos);
  none.lane_spacing_m = 0.0;
  EXPECT_FALSE(survey_routes(world, none));
}

}  // namespace
}  // namespace mstsl::sim
