#include "mstsl/grid/ray.hpp"

#include <algorithm>

namespace mstsl {
namespace {

/// Cuts `part` to where from + share * way lies in [0, extent]. Liang & Barsky's line clipping, one axis.
void clip(double from, double way, double extent, SegmentPart& part) {
  if (way == 0.0) {
    if (from < 0.0 || from > extent) part.end = -1.0;
    return;
  }
  const double a = (0.0 - from) / way, b = (extent - from) / way;
  part.begin = std::max(part.begin, std::min(a, b));
  part.end = std::min(part.end, std::max(a, b));
}

}  // namespace

SegmentPart part_over(const GridGeometry& geometry, const Eigen::Vector2d& from_cells,
                      const Eigen::Vector2d& to_cells) {
  const Eigen::Vector2d way = to_cells - from_cells;
  SegmentPart part;
  clip(from_cells.x(), way.x(), geometry.columns, part);
  clip(from_cells.y(), way.y(), geometry.rows, part);
  return part;
}

std::optional<double> cast_ray(const OccupancyGrid& grid, const Eigen::Vector2d& origin_m,
                               double direction_rad, double max_range_m) {
  const GridGeometry& geometry = grid.geometry();
  const Eigen::Vector2d from = geometry.to_grid(origin_m);
  const double direction = direction_rad - geometry.map_T_grid.yaw;
  const Eigen::Vector2d way =
      max_range_m / geometry.resolution_m * Eigen::Vector2d(std::cos(direction), std::sin(direction));
  std::optional<double> range_m;
  walk_grid(geometry, from, from + way, [&](Cell cell, double share) {
    if (grid[cell] != CellState::kOccupied) return true;
    range_m = share * max_range_m;
    return false;
  });
  return range_m;
}

Crossing crosses(const OccupancyGrid& grid, const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) {
  const Eigen::Vector2d from = grid.geometry().to_grid(from_m), to = grid.geometry().to_grid(to_m);
  if (!from.allFinite() || !to.allFinite() || !(to - from).allFinite()) return {.outside = true};
  Crossing met;
  walk_grid(grid.geometry(), from, to, [&](Cell cell, double) {
    met.wall |= grid[cell] == CellState::kOccupied;
    met.unknown |= grid[cell] == CellState::kUnknown;
    return true;
  });
  const SegmentPart part = part_over(grid.geometry(), from, to);
  met.outside = part.begin > 0.0 || part.end < 1.0;
  return met;
}

bool ends_beyond(const OccupancyGrid& grid, const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m,
                 double slack_m) {
  const Eigen::Vector2d behind_m = to_m + slack_m * (to_m - from_m).stableNormalized();
  for (const Eigen::Vector2d& end_m : {to_m, behind_m})
    if (state_at(grid, end_m) == CellState::kUnknown) return !crosses(grid, from_m, end_m).wall;
  return false;
}

}  // namespace mstsl
