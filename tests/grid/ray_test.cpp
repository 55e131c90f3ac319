#include "mstsl/grid/ray.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "grid_fixtures.hpp"

namespace mstsl {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Where a segment, in cells, enters a cell's square as a share of its way; infinity if it misses it. (Slab
/// method.)
double entry_share(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Cell cell) {
  double begin = 0, end = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double low = axis == 0 ? cell.column : cell.row;
    const double way = to[axis] - from[axis];
    const double a = (low - from[axis]) / way, b = (low + 1 - from[axis]) / way;
    begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
  }
  return begin <= end ? begin : kInfinity;
}

TEST(CastRay, AgreesWithTheSquaresOfTheCells) {
  Random random(1);
  int hits = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const OccupancyGrid grid = test::random_grid(random, 30, 20, random.uniform(0, 0.1), 0.2);
    for (int ray = 0; ray < 25; ++ray) {
      const Eigen::Vector2d origin = test::random_point(random, grid.geometry(), 10);
      const double direction = random.uniform(-kPi, kPi), range_m = random.uniform(0.1, 5);
      const Eigen::Vector2d end =
          origin + range_m * Eigen::Vector2d(std::cos(direction), std::sin(direction));
      double expected_m = kInfinity;
      for (std::size_t i = 0; i < grid.geometry().size(); ++i) {
        if (grid.values()[i] != CellState::kOccupied) continue;
        const double share = entry_share(grid.geometry().to_grid(origin), grid.geometry().to_grid(end),
                                         grid.geometry().cell(i));
        expected_m = std::min(expected_m, share * range_m);
      }
      const std::optional<double> found_m = cast_ray(grid, origin, direction, range_m);
      ASSERT_EQ(found_m.has_value(), expected_m < kInfinity);
      if (found_m) {
        EXPECT_NEAR(*found_m, expected_m, 1e-9);
        ++hits;
      }
    }
  }
  EXPECT_GT(hits, 150);
}

TEST(CastRay, IsZeroFromInsideAWall) {
  OccupancyGrid grid({.resolution_m = 0.1, .columns = 3, .rows = 3}, CellState::kOccupied);
  EXPECT_EQ(cast_ray(grid, {0.15, 0.15}, 1.0, 5.0), 0.0);
}

TEST(CastRay, LetsNothingThroughADiagonalWall) {
  OccupancyGrid grid({.resolution_m = 1.0, .columns = 20, .rows = 20}, CellState::kFree);
  for (int i = 0; i < 20; ++i) grid[{i, 19 - i}] = CellState::kOccupied;
  EXPECT_TRUE(cast_ray(grid, {2.5, 2.5}, radians(45), 50));
  EXPECT_TRUE(cast_ray(grid, {2.0, 2.0}, radians(45), 50));  // along the corners of cells
  EXPECT_TRUE(cast_ray(grid, {18.0, 18.0}, radians(-135), 50));
}

TEST(CastRay, NeedsNoMoreThanTheGridHoweverLongTheRay) {
  OccupancyGrid grid({.resolution_m = 0.05, .columns = 10, .rows = 10}, CellState::kFree);
  grid[{9, 5}] = CellState::kOccupied;
  const std::optional<double> range_m = cast_ray(grid, {-1e7, 0.275}, 0.0, 1e8);
  ASSERT_TRUE(range_m);
  EXPECT_NEAR(*range_m, 1e7 + 0.45, 1e-6);
  EXPECT_FALSE(cast_ray(grid, {-1e7, 0.275}, kPi, 1e8));
  EXPECT_FALSE(cast_ray(OccupancyGrid(), {0, 0}, 1.0, 1e8));
}

TEST(WalkCells, VisitsExactlyTheCellsThatTheSegmentEnters) {
  Random random(2);
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Vector2d from(random.uniform(-9, 9), random.uniform(-9, 9)),
        to(random.uniform(-9, 9), random.uniform(-9, 9));
    std::vector<Cell> walked;
    double last_share = 0;
    walk_cells(from, to, [&](Cell cell, double share) {
      EXPECT_NEAR(share, entry_share(from, to, cell), 1e-9);
      EXPECT_GE(share, last_share);
      last_share = share;
      walked.push_back(cell);
      return true;
    });
    std::size_t entered = 0;
    for (int column = -10; column < 10; ++column) {
      for (int row = -10; row < 10; ++row) entered += entry_share(from, to, {column, row}) < kInfinity;
    }
    EXPECT_EQ(walked.size(), entered);
    for (std::size_t i = 1; i < walked.size(); ++i) {
      EXPECT_EQ(
          std::abs(walked[i].column - walked[i - 1].column) + std::abs(walked[i].row - walked[i - 1].row), 1);
    }
  }
}

TEST(WalkCells, GoesStraightAlongCellBordersAndStandsStill) {
  for (const Eigen::Vector2d& to : {Eigen::Vector2d(7, 3), Eigen::Vector2d(-1, 3), Eigen::Vector2d(3, 8),
                                    Eigen::Vector2d(3, -2), Eigen::Vector2d(3, 3)}) {
    std::vector<Cell> walked;
    walk_cells({3, 3}, to, [&](Cell cell, double) { return walked.push_back(cell), walked.size() < 100; });
    EXPECT_EQ(walked.front(), (Cell{3, 3}));
    EXPECT_EQ(walked.back(), (Cell{static_cast<int>(to.x()), static_cast<int>(to.y())}));
    EXPECT_EQ(walked.size(), 1 + std::abs(to.x() - 3) + std::abs(to.y() - 3));
  }
}

TEST(Crosses, TellsWallsUnknownCellsAndTheOutsideApart) {
  OccupancyGrid grid({.resolution_m = 1.0, .columns = 5, .rows = 5, .map_T_grid = {10, 20, radians(90)}},
                     CellState::kFree);
  grid[{2, 2}] = CellState::kOccupied;
  grid[{3, 0}] = CellState::kUnknown;
  const auto way = [&](Eigen::Vector2d from, Eigen::Vector2d to) {
    return crosses(grid, grid.geometry().to_map(from), grid.geometry().to_map(to));
  };
  EXPECT_TRUE(way({0.5, 0.5}, {2.5, 0.5}).free());
  EXPECT_TRUE(way({0.5, 2.5}, {4.5, 2.5}).wall);
  EXPECT_FALSE(way({0.5, 2.5}, {4.5, 2.5}).leaves_known_space());
  EXPECT_TRUE(way({0.5, 0.5}, {4.5, 0.5}).unknown);
  EXPECT_FALSE(way({0.5, 0.5}, {4.5, 0.5}).wall);
  EXPECT_TRUE(way({0.5, 1.5}, {-0.5, 1.5}).outside);
  EXPECT_TRUE(way({-0.5, 1.5}, {-3.5, 1.5}).outside);
  const Crossing all = way({4.5, 4.6}, {-0.5, -0.4});
  EXPECT_TRUE(all.wall && all.outside && !all.unknown);
}

TEST(Crosses, MeetsWhatTheRayMeets) {
  Random random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    const OccupancyGrid grid = test::random_grid(random, 20, 20, 0.03, 0.1);
    const Eigen::Vector2d from = test::random_point(random, grid.geometry(), 3),
                          to = test::random_point(random, grid.geometry(), 3);
    const Eigen::Vector2d way = to - from;
    EXPECT_EQ(crosses(grid, from, to).wall,
              cast_ray(grid, from, std::atan2(way.y(), way.x()), way.norm()).has_value());
  }
}

TEST(Crosses, CallsPlacesThatAreNoneOutside) {
  const OccupancyGrid grid({.resolution_m = 1.0, .columns = 5, .rows = 5}, CellState::kFree);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(crosses(grid, {1, 1}, {nan, 1}).outside);
  EXPECT_TRUE(crosses(grid, {kInfinity, 1}, {1, 1}).outside);
  EXPECT_TRUE(crosses(grid, {-1e308, 1}, {1e308, 1}).outside);
  EXPECT_TRUE(crosses(grid, {1, 1}, {1e12, 1e12}).outside);
}

/// Free up to column 3, a wall in column 3 but for row 2, where what is known just ends.
OccupancyGrid gap_in_a_wall() {
  OccupancyGrid grid({.resolution_m = 1.0, .columns = 6, .rows = 5}, CellState::kUnknown);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 3; ++column) grid[{column, row}] = CellState::kFree;
    if (row != 2) grid[{3, row}] = CellState::kOccupied;
  }
  return grid;
}

TEST(EndsBeyond, WhereTheMapEndsButNotBehindAWall) {
  const OccupancyGrid grid = gap_in_a_wall();
  const Eigen::Vector2d from(0.5, 2.5);
  EXPECT_TRUE(ends_beyond(grid, from, {4.5, 2.5}, 0.0));
  EXPECT_TRUE(ends_beyond(grid, from, {9.5, 2.5}, 0.0)) << "beyond the grid nothing is known either";
  EXPECT_FALSE(ends_beyond(grid, from, {4.5, 4.5}, 0.0)) << "behind the wall";
  EXPECT_FALSE(ends_beyond(grid, from, {1.5, 2.5}, 0.0)) << "in the open";
  EXPECT_FALSE(ends_beyond(grid, from, from, 1.0)) << "no way at all";
}

TEST(EndsBeyond, SeesASlackFartherThanTheEnd) {
  const OccupancyGrid grid = gap_in_a_wall();
  EXPECT_FALSE(ends_beyond(grid, {0.5, 2.5}, {2.8, 2.5}, 0.1));
  EXPECT_TRUE(ends_beyond(grid, {0.5, 2.5}, {2.8, 2.5}, 0.3));
  EXPECT_FALSE(ends_beyond(grid, {0.5, 1.5}, {2.8, 1.5}, 1.5)) << "the wall stands between";
}

}  // namespace
}  // namespace mstsl
