#include <cmath>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/sim/lidar.hpp"
#include "mstsl/sim/occupancy_map.hpp"
#include "mstsl/sim/robot.hpp"
#include "mstsl/sim/run.hpp"
#include "mstsl/sim/survey.hpp"
#include "mstsl/sim/world.hpp"

#include "test_support.hpp"

namespace mstsl::sim {
namespace {

using test::must;

/// Reads a binary PGM of the real loop as map_server does; the io module's reader is not for this layer.
OccupancyGrid read_loop() {
  std::ifstream in(test::data_file("maps/corridor-loop/mymap.pgm"), std::ios::binary);
  std::string token;
  std::vector<int> header;
  in >> token;
  while (header.size() < 3) {
    in >> std::ws;
    if (in.peek() == '#')
      std::getline(in, token);
    else
      in >> header.emplace_back();
  }
  in.get();
  const GridGeometry geometry{0.05, header[0], header[1], {-24.376517, -18.846185, 0}};
  OccupancyGrid map(geometry, CellState::kUnknown);
  for (int row = geometry.rows - 1; row >= 0; --row)
    for (int column = 0; column < geometry.columns; ++column) {
      const double occupancy = (255 - in.get()) / 255.0;
      if (occupancy > 0.65)
        map[{column, row}] = CellState::kOccupied;
      else if (occupancy < 0.196)
        map[{column, row}] = CellState::kFree;
    }
  return map;
}

/// Traces a made-up building's own map back into a world.
class MapOfCorridor : public ::testing::Test {
 protected:
  World origin_ = must(make_world("corridor", {}, Random(1)));
  OccupancyGrid map_ = occupancy_map(origin_, 0.05);
  World traced_ = must(world_from_map(map_, {}, Random(2)));
};

TEST_F(MapOfCorridor, HasItsWallsWhereTheMapHasThem) {
  for (const Segment& wall : origin_.surfaces().segments())
    for (const double t : {0.0, 0.3, 0.8})
      EXPECT_LT(traced_.surfaces().clearance(point_along(wall, t), 1.0), 0.08);
  for (const Segment& wall : traced_.surfaces().segments())
    for (const double t : {0.0, 0.5})
      EXPECT_LT(origin_.surfaces().clearance(point_along(wall, t), 1.0), 0.08);
}

TEST_F(MapOfCorridor, IsSeenByLidarAsTheOriginal) {
  LidarOptions exact;
  exact.near_noise_m = exact.far_noise_m = exact.dropout = 0.0;
  exact.detection_range_m = 1e6;
  double close = 0.0, all = 0.0;
  for (int i = 0; i < 20; ++i) {
    const Trajectory standing{
        {}, 0.01, {Pose2::from(must(random_waypoint(origin_, {}, Random(i))), 0.3 * i)}};
    Random random(1);
    const auto a = scan(origin_, {}, standing, 0, default_rig().base_T_laser, exact, random);
    const auto b = scan(traced_, {}, standing, 0, default_rig().base_T_laser, exact, random);
    for (std::size_t k = 0; k < a.ranges_m.size(); ++k, all += 1.0) {
      const double tolerance = 0.05 + 0.02 * a.ranges_m[k];  // glancing beams magnify half a cell
      close += std::abs(a.ranges_m[k] - b.ranges_m[k]) < tolerance ||
               (std::isinf(a.ranges_m[k]) && std::isinf(b.ranges_m[k]));
    }
  }
  EXPECT_GT(close / all, 0.9);
}

TEST_F(MapOfCorridor, FindsTheCorridorsAsLanes) {
  double along_x = 0.0, along_y = 0.0;
  for (const Lane& lane : traced_.lanes()) {
    const Eigen::Vector2d way = lane.center.b - lane.center.a;
    std::abs(way.x()) > std::abs(way.y()) ? along_x += way.norm() : along_y += way.norm();
    EXPECT_GT(origin_.surfaces().clearance(point_along(lane.center, 0.5), 2.0), 0.6)
        << "in the middle of the corridor";
  }
  EXPECT_GT(along_x, 80.0);
  EXPECT_GT(along_y, 30.0);
}

TEST_F(MapOfCorridor, GivesBackTheMap) {
  EXPECT_EQ(occupancy_map(traced_, 0.05).values(), map_.values());
  EXPECT_GT(count(occupancy_map(traced_, 0.1), CellState::kFree), 1000u)
      << "or draws one of another resolution";
}

TEST_F(MapOfCorridor, IsDrivenAndSurveyed) {
  EXPECT_TRUE(survey_routes(traced_, {}));
  for (int i = 0; i < 10; ++i) {
    const auto run = random_run(traced_, {}, Random(i));
    ASSERT_TRUE(run) << run.error().message();
    for (const auto& point : run->waypoints_m) EXPECT_EQ(state_at(map_, point), CellState::kFree);
  }
}

TEST(WorldFromMap, FollowsABuildingThatLiesAskew) {
  OccupancyGrid map = occupancy_map(must(make_world("corridor", {}, Random(1))), 0.05);
  GridGeometry turned = map.geometry();
  turned.map_T_grid = Pose2{3, -7, radians(25)} * turned.map_T_grid;
  const World world = must(world_from_map(OccupancyGrid(turned, map.values()), {}, Random(1)));
  EXPECT_NEAR(degrees(world.plan().axis_yaw_rad), 25.0, 0.5);
  EXPECT_TRUE(random_run(world, {}, Random(1)));
}

TEST(WorldFromMap, RefusesMapsWithoutGround) {
  const GridGeometry geometry{0.05, 100, 80, {}};
  for (const CellState state : {CellState::kUnknown, CellState::kOccupied}) {
    const auto world = world_from_map(OccupancyGrid(geometry, state), {}, Random(1));
    ASSERT_FALSE(world);
    EXPECT_NE(world.error().message().find("no free space"), std::string::npos);
  }
  EXPECT_FALSE(world_from_map(OccupancyGrid(GridGeometry{0.05, 0, 0, {}}), {}, Random(1)));
  OccupancyGrid cell(geometry, CellState::kUnknown);
  cell[{50, 40}] = CellState::kFree;
  EXPECT_FALSE(world_from_map(cell, {}, Random(1)));
}

TEST(WorldFromMap, TakesTheRealCorridorLoop) {
  MSTSL_REQUIRE_DATA("maps/corridor-loop/mymap.pgm");
  const OccupancyGrid map = read_loop();
  const World world = must(world_from_map(map, {}, Random(1)));
  double lanes_m = 0.0;
  for (const Lane& lane : world.lanes()) lanes_m += length(lane.center);
  EXPECT_GT(lanes_m, 110.0) << "a loop of 61 by 22 m";
  EXPECT_LT(lanes_m, 260.0);
  std::set<int> quadrants;
  for (int i = 0; i < 20; ++i) {
    const Route run = must(random_run(world, {}, Random(i)));
    EXPECT_GE(length(run), 12.0);
    for (const auto& point : run.waypoints_m) EXPECT_EQ(state_at(map, point), CellState::kFree);
  }
  EXPECT_TRUE(survey_routes(world, {}));
}

}  // namespace
}  // namespace mstsl::sim
