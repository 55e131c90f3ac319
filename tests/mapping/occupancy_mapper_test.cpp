#include "mstsl/mapping/occupancy_mapper.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/grid/distance_field.hpp"

#include "../scan/segment_world.hpp"

namespace mstsl {
namespace {

const Eigen::Isometry3d kMounting = to_isometry3({0.2, 0.05, 0.1});

std::vector<Pose2> poses_in_room() {
  std::vector<Pose2> poses;
  for (double x = -1.5; x <= 1.5; x += 0.25) {
    for (const double yaw : {0.0, 2.0, 4.0})
      poses.push_back(Pose2::from({x, -0.5 + 0.3 * std::sin(3 * x)}, yaw));
  }
  return poses;
}

OccupancyGrid map_of(const test::Segments& walls, const std::vector<Pose2>& poses) {
  Random random(1);
  OccupancyMapper mapper;
  for (const Pose2& pose : poses) {
    const LaserScan scan = test::scan_of(walls, pose * to_pose2(kMounting), random, {.beams = 541});
    EXPECT_TRUE(mapper.insert(scan, kMounting, pose));
  }
  return mapper.grid();
}

TEST(OccupancyMapper, DrawsWallsOccupiedAndTheRoomFree) {
  const OccupancyGrid map = map_of(test::room(), poses_in_room());
  const DistanceField from_walls(test::drawn(test::room(), test::square_around({}, 6)), 2.0);
  const DistanceField from_drawn(map, 2.0);
  std::size_t occupied = 0;
  for (std::size_t i = 0; i < map.geometry().size(); ++i) {
    const Eigen::Vector2d center = map.geometry().center_of(map.geometry().cell(i));
    const double wall_m = from_walls.at(center);
    if (map.values()[i] == CellState::kOccupied) {
      ++occupied;
      EXPECT_LT(wall_m, 0.075) << center.transpose();
    }
    if (map.values()[i] == CellState::kFree) {
      EXPECT_LT(center.cwiseAbs().x(), 4.05);
      EXPECT_LT(center.cwiseAbs().y(), 3.05);
    }
  }
  EXPECT_GT(occupied, 400U);
  for (double x = -3.9; x < 2.5; x += 0.05) EXPECT_LT(from_drawn.at(Eigen::Vector2d(x, -3.0)), 0.08) << x;
  EXPECT_EQ(state_at(map, {0, 0}), CellState::kFree);
  EXPECT_EQ(state_at(map, {-2.8, 2.05}), CellState::kUnknown);  // inside the cupboard
}

TEST(OccupancyMapper, GivesTheSameMapInWhateverOrderTheScansCome) {
  std::vector<Pose2> poses = poses_in_room();
  const OccupancyGrid forth = map_of(test::room(), poses);
  std::ranges::reverse(poses);
  const OccupancyGrid back = map_of(test::room(), poses);
  EXPECT_EQ(forth.geometry(), back.geometry());
  EXPECT_EQ(forth.values(), back.values());
}

TEST(OccupancyMapper, GrowsWithTheRobotAndIsCutToWhatWasSeen) {
  const test::Segments walls = test::rectangle(-60, -1.02, 60, 1.02);
  std::vector<Pose2> poses;
  for (double x = -50; x <= 50; x += 1) poses.push_back({x, 0, 0});
  const OccupancyGrid map = map_of(walls, poses);
  EXPECT_NEAR(map.geometry().columns * 0.05, 2 * 60 - 10, 15);
  EXPECT_NEAR(map.geometry().rows * 0.05, 2.1, 0.1);
  for (double x = -40; x < 40; x += 0.5) EXPECT_EQ(state_at(map, {x, 0.3}), CellState::kFree);
  EXPECT_NEAR(std::remainder(map.geometry().map_T_grid.x, 0.05), 0, 1e-9);  // cells stay in place as it grows
}

TEST(OccupancyMapper, ErasesPeopleWhoHaveWalkedOn) {
  Random random(2);
  OccupancyMapper mapper;
  const test::Segments person = test::rectangle(1.0, 0.0, 1.2, 0.2);
  for (int i = 0; i < 12; ++i) {
    const test::Segments walls = i < 2 ? test::joined(test::room(), person) : test::room();
    EXPECT_TRUE(
        mapper.insert(test::scan_of(walls, {-1, 0, 0}, random), Eigen::Isometry3d::Identity(), {-1, 0, 0}));
  }
  EXPECT_EQ(state_at(mapper.grid(), {1.02, 0.1}), CellState::kFree);
}

TEST(OccupancyMapper, RefusesPosesThatAreNoneAndMapsWithoutEnd) {
  Random random(3);
  OccupancyMapper mapper({.max_cells = 1'000'000});
  const LaserScan scan = test::scan_of(test::room(), {}, random);
  const Eigen::Isometry3d mounting = Eigen::Isometry3d::Identity();
  ASSERT_TRUE(mapper.insert(scan, mounting, {}));
  const OccupancyGrid before = mapper.grid();
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           1e300, -1e300, 1e12, 1e5}) {
    const Result<void> drawn = mapper.insert(scan, mounting, {bad, 0, 0});
    ASSERT_FALSE(drawn) << bad;
    EXPECT_NE(drawn.error().message().find("pose"), std::string::npos);
  }
  EXPECT_EQ(mapper.grid().values(), before.values());
  OccupancyMapper fresh;
  EXPECT_FALSE(fresh.insert(scan, mounting, {1e300, 1e300, 0}));
}

TEST(OccupancyMapper, TakesScansWithoutReturns) {
  OccupancyMapper mapper;
  EXPECT_TRUE(mapper.insert(LaserScan{}, Eigen::Isometry3d::Identity(), {}));
  EXPECT_EQ(mapper.grid().geometry().size(), 0U);
}

}  // namespace
}  // namespace mstsl
