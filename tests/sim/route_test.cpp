#include "mstsl/sim/route.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/sim/run.hpp"

#include "test_support.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;
using test::must;

World corridor() { return must(make_world("corridor", {}, Random(1))); }

double least_clearance(const World& world, const std::vector<Vector2d>& path) {
  double least = 10.0;
  for (const Segment& leg : polyline(path, false))
    for (double t = 0; t <= 1.0; t += 0.01)
      least = std::min(least, world.surfaces().clearance(point_along(leg, t), 2.0));
  return least;
}

TEST(Route, IsCutToALength) {
  const Route route{0.5, {{0, 0}, {3, 0}, {3, 4}}};
  EXPECT_DOUBLE_EQ(length(route), 7.0);
  EXPECT_DOUBLE_EQ(length(truncated(route, 5.0)), 5.0);
  EXPECT_EQ(truncated(route, 5.0).waypoints_m.back(), Vector2d(3, 2));
  EXPECT_DOUBLE_EQ(length(truncated(route, 50.0)), 7.0);
  EXPECT_EQ(truncated(route, 0.0).waypoints_m.size(), 1u);
}

TEST(PlanPath, LeadsRoundTheBlockWithRoomOnBothSides) {
  const World world = corridor();
  const Vector2d start = point_along(world.lanes()[0].center, 0.5),
                 goal = point_along(world.lanes()[1].center, 0.5);
  const auto path = must(plan_path(world, start, goal));
  EXPECT_EQ(path.front(), start);
  EXPECT_EQ(path.back(), goal);
  EXPECT_GT(least_clearance(world, path), 0.3);
  double whole = 0.0;
  for (const Segment& leg : polyline(path, false)) whole += length(leg);
  EXPECT_GT(whole, 60.0) << "there is no way through the inner block";
  EXPECT_LT(whole, 85.0);
  EXPECT_LT(path.size(), 20u) << "straightened";
}

TEST(PlanPath, SaysWhenAnEndCannotBeReached) {
  const World world = corridor();
  const Vector2d start = point_along(world.lanes()[0].center, 0.5);
  const auto inside_the_block = plan_path(world, start, {0, 0});
  ASSERT_FALSE(inside_the_block);
  EXPECT_NE(inside_the_block.error().message().find("drive"), std::string::npos);
  EXPECT_FALSE(plan_path(world, {1e7, std::nan("")}, start));
}

TEST(RandomRun, StartsAnywhereHeadingAnywhere) {
  const World world = corridor();
  std::set<int> quadrants, places;
  for (int i = 0; i < 60; ++i) {
    const Route route = must(random_run(world, {}, Random(i)));
    EXPECT_NEAR(length(route), RunOptions{}.length_m, 1e-9);
    EXPECT_GT(least_clearance(world, route.waypoints_m), 0.25);
    quadrants.insert(static_cast<int>(std::floor(route.start_yaw_rad / (kPi / 2))));
    places.insert((route.waypoints_m[0].x() > 0) + 2 * (route.waypoints_m[0].y() > 0));
  }
  EXPECT_EQ(quadrants.size(), 4u);
  EXPECT_EQ(places.size(), 4u);
}

TEST(RandomRun, IsReachableInEveryWorld) {
  for (const std::string& name : world_names()) {
    const World world = must(make_world(name, {}, Random(2)));
    for (int i = 0; i < 15; ++i) {
      const Route route = must(random_run(world, {}, Random(i)));
      EXPECT_GE(length(route), 12.0) << name;
      EXPECT_GT(least_clearance(world, route.waypoints_m), 0.25) << name;
    }
  }
}

TEST(RandomRun, ToursWhereNoSingleWayIsSoLong) {
  const World world = corridor();
  RunOptions options;
  options.length_m = 1000.0;
  const Route route = must(random_run(world, options, Random(1)));
  EXPECT_NEAR(length(route), 1000.0, 1e-6);
  EXPECT_GT(least_clearance(world, route.waypoints_m), 0.25);
}

TEST(RouteFrom, SaysWhenNoWayIsSoLong) {
  const World world = corridor();
  RunOptions options;
  options.length_m = 1000.0;
  const auto route = route_from(world, must(random_waypoint(world, options, Random(2))), options, Random(1));
  ASSERT_FALSE(route);
  EXPECT_NE(route.error().message().find("shorter"), std::string::npos);
}

TEST(RandomRun, SaysWhenNoLaneIsWideEnough) {
  RunOptions options;
  options.path.clearance_m = 1.9;
  EXPECT_FALSE(random_run(corridor(), options, Random(1)));
}

}  // namespace
}  // namespace mstsl::sim
