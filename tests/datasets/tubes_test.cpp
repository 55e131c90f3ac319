#include "mstsl/datasets/tubes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/sim/segment_index.hpp"

#include "test_support.hpp"

namespace mstsl::datasets {
namespace {

Path zigzag(Random& random) {
  Path path_m = {{0.0, 0.0}};
  for (int i = 0; i < 12; ++i)
    path_m.emplace_back(path_m.back() +
                        Eigen::Vector2d(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)));
  return path_m;
}

double distance_to(const std::vector<Path>& paths_m, const Eigen::Vector2d& point_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Path& path_m : paths_m)
    for (std::size_t i = 1; i < path_m.size(); ++i)
      nearest_m = std::min(nearest_m, sim::distance(point_m, {path_m[i - 1], path_m[i]}));
  return nearest_m;
}

TEST(Tubes, AreFreeExactlyWithinHalfTheirWidth) {
  Random random(5);
  const std::vector<Path> paths_m = {zigzag(random), zigzag(random)};
  const OccupancyGrid grid = test::must(tubes_around(paths_m, {.width_m = 2.2, .resolution_m = 0.1}));
  for (std::size_t i = 0; i < grid.geometry().size(); ++i) {
    const Cell cell = grid.geometry().cell(i);
    const bool inside = distance_to(paths_m, grid.geometry().center_of(cell)) <= 1.1;
    ASSERT_EQ(grid[cell] == CellState::kFree, inside) << cell.column << ", " << cell.row;
  }
}

TEST(Tubes, AreClosedByAWallOnEverySide) {
  const OccupancyGrid grid = test::must(tubes_around(std::vector<Path>{{{0.0, 0.0}, {4.0, 1.0}}}));
  const GridGeometry& geometry = grid.geometry();
  for (std::size_t i = 0; i < geometry.size(); ++i) {
    const Cell cell = geometry.cell(i);
    const bool rim = cell.column == 0 || cell.row == 0 || cell.column == geometry.columns - 1 ||
                     cell.row == geometry.rows - 1;
    ASSERT_TRUE(!rim || grid[cell] == CellState::kOccupied);
  }
}

TEST(Tubes, HaveWallsHalfTheirWidthFromTheirMiddle) {
  const sim::WorldPlan plan = test::must(tube_plan(std::vector<Path>{{{0.0, 0.0}, {20.0, 5.0}}}));
  const sim::SegmentIndex walls(plan.walls);
  for (double share = 0.0; share <= 1.0; share += 0.05)
    EXPECT_NEAR(walls.clearance(share * Eigen::Vector2d(20.0, 5.0), 5.0), 1.1, 0.05);
}

TEST(Tubes, HaveNoWallButTheirOwn) {
  const std::vector<Path> ring_m = {{{0.0, 0.0}, {12.0, 0.0}, {12.0, 8.0}, {0.0, 8.0}, {0.0, 0.0}}};
  const sim::WorldPlan plan = test::must(tube_plan(ring_m));
  double inside_m = 0.0, outside_m = 0.0;
  for (const sim::Segment& wall : plan.walls) {
    EXPECT_NEAR(distance_to(ring_m, sim::point_along(wall, 0.5)), 1.1, 0.08);
    const Eigen::Vector2d middle_m = sim::point_along(wall, 0.5) - Eigen::Vector2d(6.0, 4.0);
    const bool inner = std::abs(middle_m.x()) < 6.0 && std::abs(middle_m.y()) < 4.0;
    (inner ? inside_m : outside_m) += sim::length(wall);
  }
  EXPECT_NEAR(inside_m, 2.0 * (9.8 + 5.8), 0.5);                      // the block in the middle
  EXPECT_NEAR(outside_m, 2.0 * (12.0 + 8.0) + 2.0 * kPi * 1.1, 0.7);  // with its rounded corners
}

TEST(Tubes, HaveLanesThatStayInThem) {
  Random random(6);
  const Path path_m = zigzag(random);
  const sim::WorldPlan plan = test::must(tube_plan(std::vector<Path>{path_m}));
  ASSERT_FALSE(plan.lanes.empty());
  for (const sim::Lane& lane : plan.lanes)
    for (double share = 0.0; share <= 1.0; share += 0.1)
      EXPECT_LE(distance_to({path_m}, sim::point_along(lane.center, share)), 2.2 / 8.0 + 1e-9);
}

TEST(Tubes, RefuseNothingAndTheImpossible) {
  EXPECT_FALSE(tubes_around(std::vector<Path>{}).ok());
  EXPECT_FALSE(tubes_around(std::vector<Path>{{}}).ok());
  EXPECT_FALSE(tubes_around(std::vector<Path>{{{0.0, 0.0}, {std::nan(""), 0.0}}}).ok());
  const auto far = tubes_around(std::vector<Path>{{{0.0, 0.0}, {1e7, 0.0}}});
  ASSERT_FALSE(far.ok());
  EXPECT_NE(far.error().message().find("no building"), std::string::npos);
}

TEST(SharedAxis, IsFoundWhicheverWayThePathIsWalked) {
  const double axis_rad = radians(12.0);
  const Eigen::Vector2d along(std::cos(axis_rad), std::sin(axis_rad));
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Vector2d start(3.0, 4.0);
  const Path loop_m = {start, start + 30.0 * along, start + 30.0 * along + 10.0 * across,
                       start + 10.0 * across, start};
  EXPECT_NEAR(shared_axis_rad(std::array{loop_m}), axis_rad, 1e-9);
}

}  // namespace
}  // namespace mstsl::datasets
