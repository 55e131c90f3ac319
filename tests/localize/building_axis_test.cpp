#include "mstsl/localize/building_axis.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

/// A room of 30 m x 8 m with walls two cells thick, turned by `yaw_rad` in the map, on a grid that is itself
/// turned.
OccupancyGrid room(double yaw_rad, double grid_yaw_rad) {
  const GridGeometry geometry{0.05, 800, 800, {-20.0, -20.0, grid_yaw_rad}};
  OccupancyGrid map(geometry, CellState::kUnknown);
  const Eigen::Vector2d middle = geometry.to_map({400, 400});
  for (std::size_t i = 0; i < geometry.size(); ++i) {
    const Eigen::Vector2d p = Eigen::Rotation2Dd(-yaw_rad) * (geometry.center_of(geometry.cell(i)) - middle);
    const double outside = std::max(std::abs(p.x()) - 15.0, std::abs(p.y()) - 4.0);
    if (outside < 0.0)
      map.values()[i] = CellState::kFree;
    else if (outside < 0.1)
      map.values()[i] = CellState::kOccupied;
  }
  return map;
}

TEST(BuildingAxis, IsTheWallsDirectionInTheMapFrame) {
  for (const double yaw_deg : {0.0, 3.3, 17.0, 44.0, -30.0}) {
    const auto axis = building_axis(room(radians(yaw_deg), 0.0));
    ASSERT_TRUE(axis);
    EXPECT_NEAR(degrees(*axis), yaw_deg, 0.1);
  }
}

TEST(BuildingAxis, DoesNotDependOnTheYawOfTheGrid) {
  EXPECT_NEAR(degrees(*building_axis(room(radians(10.0), radians(25.0)))), 10.0, 0.1);
  EXPECT_NEAR(degrees(*building_axis(room(0.0, radians(120.0)))), 0.0, 0.1);
}

TEST(BuildingAxis, SaysNothingOfAMapWithoutWalls) {
  EXPECT_FALSE(building_axis(OccupancyGrid(GridGeometry{0.05, 50, 50, {}}, CellState::kFree)));
  EXPECT_FALSE(building_axis(OccupancyGrid()));
}

}  // namespace
}  // namespace mstsl
