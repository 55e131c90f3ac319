#include "mstsl/grid/outline.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

using Eigen::Vector2d;

/// '#' is occupied; the first line is the top row.
OccupancyGrid drawn(const std::vector<std::string>& lines) {
  OccupancyGrid map({1.0, static_cast<int>(lines[0].size()), static_cast<int>(lines.size()), {}},
                    CellState::kFree);
  for (int row = 0; row < map.geometry().rows; ++row)
    for (int column = 0; column < map.geometry().columns; ++column)
      if (lines[lines.size() - 1 - static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] == '#')
        map[{column, row}] = CellState::kOccupied;
  return map;
}

double area(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

double distance_to(const std::vector<Polygon>& polygons, const Vector2d& point) {
  double nearest = 1e9;
  for (const Polygon& polygon : polygons)
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector2d a = polygon[i], along = polygon[(i + 1) % polygon.size()] - a;
      const double share =
          along.squaredNorm() > 0 ? std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0.0;
      nearest = std::min(nearest, (point - a - share * along).norm());
    }
  return nearest;
}

bool is_border(const OccupancyGrid& map, Cell cell) {
  if (map[cell] != CellState::kOccupied) return false;
  for (const Cell step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
    const Cell next{cell.column + step.column, cell.row + step.row};
    if (!map.contains(next) || map[next] != CellState::kOccupied) return true;
  }
  return false;
}

TEST(OccupiedOutlines, RunThroughTheBorderCellsOfABlock) {
  const auto outlines = occupied_outlines(drawn({"......", ".####.", ".####.", ".####.", "......"}), 0.0);
  ASSERT_EQ(outlines.size(), 1u);
  EXPECT_EQ(outlines[0].size(), 4u);
  EXPECT_DOUBLE_EQ(area(outlines[0]), 3.0 * 2.0) << "counter-clockwise";
}

TEST(OccupiedOutlines, GoRoundHolesTheOtherWay) {
  const auto outlines = occupied_outlines(drawn({"#####", "#...#", "#...#", "#####"}), 0.0);
  ASSERT_EQ(outlines.size(), 2u);
  EXPECT_DOUBLE_EQ(std::max(area(outlines[0]), area(outlines[1])), 4.0 * 3.0);
  EXPECT_LT(std::min(area(outlines[0]), area(outlines[1])), 0.0);
}

TEST(OccupiedOutlines, TakeAWallOneCellThickAsALine) {
  const auto outlines = occupied_outlines(drawn({".....", "#####", "....."}), 0.1);
  ASSERT_EQ(outlines.size(), 1u);
  EXPECT_EQ(outlines[0].size(), 2u);
  EXPECT_DOUBLE_EQ(outlines[0][0].y(), 1.5);
  EXPECT_DOUBLE_EQ(area(outlines[0]), 0.0);
}

TEST(OccupiedOutlines, LeaveNoGapWhereCellsTouchAtACorner) {
  const auto outlines = occupied_outlines(drawn({"...#", "..#.", ".#..", "#..."}), 0.1);
  ASSERT_EQ(outlines.size(), 1u);
  EXPECT_EQ(outlines[0].size(), 2u) << "one diagonal line";
}

TEST(OccupiedOutlines, ShowALoneCell) {
  const auto outlines = occupied_outlines(drawn({"...", ".#.", "..."}));
  ASSERT_EQ(outlines.size(), 1u);
  EXPECT_GT(area(outlines[0]), 0.0);
  EXPECT_LT(area(outlines[0]), 1.0);
}

TEST(OccupiedOutlines, AreNoneWhereNothingIsOccupied) {
  EXPECT_TRUE(occupied_outlines(drawn({"...", "..."})).empty());
  EXPECT_TRUE(occupied_outlines(OccupancyGrid{}).empty());
}

TEST(OccupiedOutlines, PassEveryBorderCellWithinTheTolerance) {
  Random random(1);
  for (const double density : {0.1, 0.4, 0.6, 0.9})
    for (const double tolerance_cells : {0.0, 0.5, 1.5}) {
      OccupancyGrid map({0.05, 40, 30, {2, -1, radians(20)}}, CellState::kFree);
      for (CellState& state : map.values())
        if (random.chance(density)) state = random.chance(0.2) ? CellState::kUnknown : CellState::kOccupied;
      const auto outlines = occupied_outlines(map, 0.05 * tolerance_cells);
      for (std::size_t i = 0; i < map.values().size(); ++i) {
        const Cell cell = map.geometry().cell(i);
        if (!is_border(map, cell)) continue;
        EXPECT_LE(distance_to(outlines, map.geometry().center_of(cell)), 0.05 * (tolerance_cells + 0.251));
      }
      for (const Polygon& polygon : outlines)
        for (const Vector2d& corner : polygon) EXPECT_EQ(state_at(map, corner), CellState::kOccupied);
    }
}

TEST(OccupiedOutlines, AreFewLinesForASlantedWall) {
  OccupancyGrid map({0.05, 400, 100, {}}, CellState::kFree);
  for (int column = 0; column < 400; ++column) map[{column, 20 + column / 8}] = CellState::kOccupied;
  const auto outlines = occupied_outlines(map);
  ASSERT_EQ(outlines.size(), 1u);
  EXPECT_LE(outlines[0].size(), 8u) << "one line a few cells long each would be 100";
}

}  // namespace
}  // namespace mstsl
