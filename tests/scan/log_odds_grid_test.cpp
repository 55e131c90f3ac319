#include "mstsl/scan/log_odds_grid.hpp"

#include <gtest/gtest.h>

#include "segment_world.hpp"

namespace mstsl {
namespace {

TEST(LogOddsGrid, RaisesTheEndOfABeamAndLowersItsWay) {
  LogOddsGrid grid({.resolution_m = 1.0, .columns = 10, .rows = 3});
  grid.draw({{{0.5, 0.5}, {5.5, 0.5}}}, {0, 1, 0});
  for (int column = 0; column < 10; ++column) {
    const double expected = column < 5 ? -0.4 : column == 5 ? 0.85 : 0.0;
    EXPECT_NEAR((grid.values()[{column, 1}]), expected, 1e-6) << column;
    EXPECT_EQ((grid.values()[{column, 0}]), 0.0F);
  }
}

TEST(LogOddsGrid, CountsAScanOnceInACellAndHitsBeforeMisses) {
  LogOddsGrid grid({.resolution_m = 1.0, .columns = 10, .rows = 1});
  grid.draw({{{0.5, 0.5}, {9.5, 0.5}}, {{0.5, 0.5}, {5.5, 0.5}}, {{0.5, 0.5}, {5.4, 0.5}}}, {});
  EXPECT_NEAR((grid.values()[{5, 0}]), 0.85, 1e-6);
  EXPECT_NEAR((grid.values()[{2, 0}]), -0.4, 1e-6);
}

TEST(LogOddsGrid, StopsAtItsLimit) {
  LogOddsGrid grid({.resolution_m = 1.0, .columns = 10, .rows = 1});
  for (int i = 0; i < 100; ++i) grid.draw({{{0.5, 0.5}, {5.5, 0.5}}}, {});
  EXPECT_EQ((grid.values()[{5, 0}]), 6.0F);
  EXPECT_EQ((grid.values()[{2, 0}]), -6.0F);
}

TEST(LogOddsGrid, OnlyClearsTheWayTowardsAFarReturn) {
  LogOddsGrid grid({.resolution_m = 1.0, .columns = 10, .rows = 1}, {.max_range_m = 3.0});
  grid.draw({{{0.5, 0.5}, {5.5, 0.5}}}, {});
  EXPECT_LT((grid.values()[{3, 0}]), 0);
  EXPECT_EQ((grid.values()[{4, 0}]), 0);
  EXPECT_EQ((grid.values()[{5, 0}]), 0);
}

TEST(LogOddsGrid, LeavesOutWhatLiesOutside) {
  LogOddsGrid grid({.resolution_m = 1.0, .columns = 10, .rows = 1}, {.max_range_m = 1e12});
  grid.draw({{{-1e9, 0.5}, {1e9, 0.5}}, {{0.5, 0.5}, {0.5, 1e300}}}, {});
  for (const float value : grid.values().values()) EXPECT_NEAR(value, -0.4, 1e-6);
}

TEST(LogOddsGrid, KeepsItsBeliefWhenItMoves) {
  Random random(1);
  LogOddsGrid grid(test::square_around({1, 2, 0.5}, 5));
  grid.draw(beam_returns(test::scan_of(test::room(), {}, random), Eigen::Isometry3d::Identity()),
            {1, 2, 0.3});
  GridGeometry wider = grid.geometry();
  wider.map_T_grid = wider.map_T_grid * Pose2{-0.35, -0.6, 0};
  wider.columns += 30, wider.rows += 20;
  const LogOddsGrid moved = grid.moved_to(wider);
  for (std::size_t i = 0; i < grid.geometry().size(); ++i) {
    const Cell cell = grid.geometry().cell(i);
    EXPECT_EQ((moved.values()[{cell.column + 7, cell.row + 12}]), grid.values().values()[i]);
  }
  const LogOddsGrid back = moved.moved_to(grid.geometry());
  EXPECT_EQ(back.values().values(), grid.values().values());
}

TEST(LogOddsGrid, ReadsAsOccupiedFreeAndUnknown) {
  LogOddsGrid grid({.resolution_m = 1.0, .columns = 4, .rows = 1});
  grid.draw({{{0.5, 0.5}, {2.5, 0.5}}}, {});
  const OccupancyGrid states = grid.occupancy(0.65, 0.45);
  EXPECT_EQ(states.values(),
            (std::vector{CellState::kFree, CellState::kFree, CellState::kOccupied, CellState::kUnknown}));
  EXPECT_EQ(grid.occupancy(0.65, 0.196).values()[0], CellState::kUnknown);
}

}  // namespace
}  // namespace mstsl
