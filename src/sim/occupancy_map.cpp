#include "mstsl/sim/occupancy_map.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mstsl/grid/ray.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;

/// Room for a margin of unknown cells around everything, as maps made by SLAM have.
constexpr double kMargin_m = 1.0;

GridGeometry geometry_of(const World& world, double resolution_m) {
  Eigen::AlignedBox2d area = world.plan().footprint_m;
  for (const Segment& s : world.surfaces().segments()) {
    area.extend(s.a);
    area.extend(s.b);
  }
  const Vector2d low = ((area.min().array() - kMargin_m) / resolution_m).floor() * resolution_m;
  const Vector2d size = (area.max() - low).array() + kMargin_m;
  return {resolution_m, static_cast<int>(size.x() / resolution_m) + 1,
          static_cast<int>(size.y() / resolution_m) + 1, Pose2::from(low, 0)};
}

void draw(OccupancyGrid& map, const Segment& segment) {
  const GridGeometry& geometry = map.geometry();
  walk_grid(geometry, geometry.to_grid(segment.a), geometry.to_grid(segment.b), [&](Cell cell, double) {
    map[cell] = CellState::kOccupied;
    return true;
  });
}

/// Marks what can be reached from the lanes inside the footprint as free.
void flood(OccupancyGrid& map, const World& world) {
  std::vector<Cell> open;
  const auto visit = [&](Cell cell) {
    if (!map.contains(cell) || map[cell] != CellState::kUnknown) return;
    if (!world.plan().footprint_m.contains(map.geometry().center_of(cell))) return;
    map[cell] = CellState::kFree;
    open.push_back(cell);
  };
  for (const Lane& lane : world.lanes()) {
    const int steps = 1 + static_cast<int>(length(lane.center) / map.geometry().resolution_m);
    for (int i = 0; i <= steps; ++i)
      visit(map.geometry().cell_at(point_along(lane.center, static_cast<double>(i) / steps)));
  }
  while (!open.empty()) {
    const Cell cell = open.back();
    open.pop_back();
    for (const Cell step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}})
      visit({cell.column + step.column, cell.row + step.row});
  }
}

}  // namespace

OccupancyGrid occupancy_map(const World& world, double resolution_m) {
  const auto& ground = world.plan().ground;
  if (ground && ground->geometry().resolution_m == resolution_m) return *ground;
  OccupancyGrid map(geometry_of(world, resolution_m), CellState::kUnknown);
  for (const Segment& segment : world.surfaces().segments()) draw(map, segment);
  flood(map, world);
  return map;
}

}  // namespace mstsl::sim
