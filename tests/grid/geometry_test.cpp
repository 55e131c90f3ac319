#include "mstsl/grid/geometry.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "mstsl/grid/crop.hpp"
#include "mstsl/grid/frame.hpp"

#include "grid_fixtures.hpp"

namespace mstsl {
namespace {

TEST(GridGeometry, PutsEachCellsCentreIntoThatCell) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const GridGeometry geometry = test::random_grid(random, 50, 40, 0).geometry();
    const std::size_t index = random.index(geometry.size());
    EXPECT_EQ(geometry.index(geometry.cell(index)), index);
    EXPECT_EQ(geometry.cell_at(geometry.center_of(geometry.cell(index))), geometry.cell(index));
  }
}

TEST(GridFrame, GivesTheGeometrysAnswers) {
  Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const GridGeometry geometry = test::random_grid(random, 50, 40, 0).geometry();
    const GridFrame frame(geometry);
    const Eigen::Vector2d p = test::random_point(random, geometry, 30),
                          q = test::random_point(random, geometry, 30);
    EXPECT_NEAR((frame.to_grid(p) - geometry.to_grid(p)).norm(), 0, 1e-9);
    EXPECT_NEAR((frame.to_map(frame.to_grid(p)) - p).norm(), 0, 1e-9);
    EXPECT_NEAR((frame.vector_to_grid(p - q) - (frame.to_grid(p) - frame.to_grid(q))).norm(), 0, 1e-9);
    EXPECT_NEAR((frame.vector_to_map(frame.vector_to_grid(p)) - p).norm(), 0, 1e-9);
    EXPECT_EQ(frame.cell_at(frame.center_of({3, 4})), (Cell{3, 4}));
  }
}

TEST(GridFrame, PutsPointsThatAreNoneIntoNoCell) {
  const GridGeometry geometry{.resolution_m = 0.05, .columns = 10, .rows = 10};
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300, 1e300}) {
    EXPECT_FALSE(geometry.contains(geometry.cell_at({bad, 0.1})));
    EXPECT_FALSE(geometry.contains(GridFrame(geometry).cell_at({0.1, bad})));
  }
}

TEST(Crop, HoldsTheSameStatesAtTheSamePlaces) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const OccupancyGrid grid = test::random_grid(random, 40, 30, 0.3, 0.3);
    const Eigen::Vector2d center = test::random_point(random, grid.geometry(), 20);
    const double half_size_m = random.uniform(0, 2.5);
    const OccupancyGrid part = crop(grid, center, half_size_m);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector2d p = test::random_point(random, grid.geometry());
      const Eigen::Vector2d away = grid.geometry().to_grid(p) - grid.geometry().to_grid(center);
      const bool near = away.cwiseAbs().maxCoeff() * grid.geometry().resolution_m < half_size_m;
      EXPECT_TRUE(!near || state_at(part, p) == state_at(grid, p));
    }
    EXPECT_LE(part.geometry().columns, 2 * half_size_m / 0.1 + 2);
    EXPECT_LE(part.geometry().rows, 2 * half_size_m / 0.1 + 2);
  }
}

TEST(Crop, OfAPlaceBeyondTheMapIsEmpty) {
  const OccupancyGrid grid({.resolution_m = 1.0, .columns = 5, .rows = 5}, CellState::kFree);
  EXPECT_EQ(crop(grid, {100, 100}, 3).geometry().size(), 0U);
  EXPECT_EQ(crop(grid, {2, -100}, 3).geometry().size(), 0U);
}

}  // namespace
}  // namespace mstsl
