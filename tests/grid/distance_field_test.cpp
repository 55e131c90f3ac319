#include "mstsl/grid/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "grid_fixtures.hpp"

namespace mstsl {
namespace {

double brute_force_distance_m(const OccupancyGrid& grid, Cell cell, double max_m) {
  double nearest_m = max_m;
  for (std::size_t i = 0; i < grid.geometry().size(); ++i) {
    if (grid.values()[i] != CellState::kOccupied) continue;
    const Cell other = grid.geometry().cell(i);
    nearest_m = std::min(nearest_m, grid.geometry().resolution_m *
                                        std::hypot(other.column - cell.column, other.row - cell.row));
  }
  return nearest_m;
}

TEST(DistanceField, AgreesWithBruteForce) {
  Random random(1);
  for (int trial = 0; trial < 60; ++trial) {
    const int columns = 1 + static_cast<int>(random.index(40)), rows = 1 + static_cast<int>(random.index(40));
    const OccupancyGrid grid = test::random_grid(random, columns, rows, random.uniform(0, 0.05), 0.3);
    const double max_m = random.uniform(0.05, 5.0);
    const DistanceField field(grid, max_m);
    for (std::size_t i = 0; i < grid.geometry().size(); ++i) {
      const Cell cell = grid.geometry().cell(i);
      ASSERT_NEAR(field.at(cell), brute_force_distance_m(grid, cell, max_m), 1e-6)
          << trial << " at " << cell.column << ", " << cell.row;
    }
  }
}

TEST(DistanceField, IsTheMaximumWhereThereIsNoWall) {
  Random random(2);
  const OccupancyGrid grid = test::random_grid(random, 7, 5, 0);
  const DistanceField field(grid, 2.5);
  EXPECT_EQ(field.at(Cell{3, 2}), 2.5);
  EXPECT_EQ(field.at(Cell{-1, 2}), 2.5);
  EXPECT_EQ(field.at(grid.geometry().to_map({100, 100})), 2.5);
  EXPECT_EQ(field.at(Eigen::Vector2d(std::numeric_limits<double>::quiet_NaN(), 0)), 2.5);
  EXPECT_EQ(DistanceField(OccupancyGrid(), 2.5).at(Eigen::Vector2d::Zero()), 2.5);
}

TEST(DistanceField, InterpolatesBetweenCellCentres) {
  Random random(3);
  const OccupancyGrid grid = test::random_grid(random, 30, 20, 0.02);
  const DistanceField field(grid, 10.0);
  for (int i = 0; i < 200; ++i) {
    const Cell cell{static_cast<int>(random.index(29)), static_cast<int>(random.index(19))};
    EXPECT_NEAR(field.at(grid.geometry().center_of(cell)), field.at(cell), 1e-6);
    const Eigen::Vector2d middle = grid.geometry().to_map({cell.column + 1.0, cell.row + 1.0});
    const double mean =
        (field.at(cell) + field.at(Cell{cell.column + 1, cell.row}) +
         field.at(Cell{cell.column, cell.row + 1}) + field.at(Cell{cell.column + 1, cell.row + 1})) /
        4;
    EXPECT_NEAR(field.at(middle), mean, 1e-6);
  }
}

TEST(DistanceField, ChangesNoFasterThanOneMoves) {
  Random random(4);
  const OccupancyGrid grid = test::random_grid(random, 30, 20, 0.02);
  const DistanceField field(grid, 10.0);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d a = test::random_point(random, grid.geometry()),
                          b = test::random_point(random, grid.geometry());
    // Bilinear interpolation of a field of slope 1 has slope at most sqrt 2.
    EXPECT_LE(std::abs(field.at(a) - field.at(b)), std::sqrt(2.0) * (a - b).norm() + 1e-6);
  }
}

}  // namespace
}  // namespace mstsl
