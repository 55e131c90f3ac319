#pragma once

#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include "mstsl/grid/geometry.hpp"
#include "mstsl/grid/occupancy_grid.hpp"

namespace mstsl {

/// Visits every cell that the segment between two points (in cells, GridGeometry::to_grid) passes through, in
/// order: `visit(cell, share)` with the share of the way, 0 .. 1, at which the segment enters the cell; it
/// returns false to stop. Successive cells share an edge, so a diagonal wall lets nothing through. Cells may
/// lie outside the grid. Expects finite points within 1e9 cells of the origin. Amanatides & Woo, "A fast
/// voxel traversal algorithm", 1987.
template <typename Visit>
void walk_cells(const Eigen::Vector2d& from_cells, const Eigen::Vector2d& to_cells, Visit visit) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d way = to_cells - from_cells;
  Cell cell{static_cast<int>(std::floor(from_cells.x())), static_cast<int>(std::floor(from_cells.y()))};
  const Cell last{static_cast<int>(std::floor(to_cells.x())), static_cast<int>(std::floor(to_cells.y()))};
  const int step_x = way.x() < 0 ? -1 : 1, step_y = way.y() < 0 ? -1 : 1;
  int left_x = std::abs(last.column - cell.column), left_y = std::abs(last.row - cell.row);
  // Crossings are computed from the cell's own border each time: no error adds up along a long ray.
  const auto crossing_x = [&] {
    return left_x == 0 ? kNever : (cell.column + (step_x > 0) - from_cells.x()) / way.x();
  };
  const auto crossing_y = [&] {
    return left_y == 0 ? kNever : (cell.row + (step_y > 0) - from_cells.y()) / way.y();
  };
  double next_x = crossing_x(), next_y = crossing_y(), share = 0.0;
  while (visit(cell, share) && (left_x > 0 || left_y > 0)) {
    if (next_x < next_y) {
      share = next_x, cell.column += step_x, --left_x, next_x = crossing_x();
    } else {
      share = next_y, cell.row += step_y, --left_y, next_y = crossing_y();
    }
  }
}

/// The part of a segment, as shares of its way, that lies over a grid; there is none when begin > end.
struct SegmentPart {
  double begin = 0.0;
  double end = 1.0;
};
SegmentPart part_over(const GridGeometry& geometry, const Eigen::Vector2d& from_cells,
                      const Eigen::Vector2d& to_cells);

/// walk_cells() along the part of a segment over a grid, so that the work is bounded by the grid however far
/// the ends lie. `visit(cell, share)` sees cells of the grid only. Expects finite points a finite way apart.
template <typename Visit>
void walk_grid(const GridGeometry& geometry, const Eigen::Vector2d& from_cells,
               const Eigen::Vector2d& to_cells, Visit visit) {
  const SegmentPart part = part_over(geometry, from_cells, to_cells);
  if (part.begin > part.end) return;
  const Eigen::Vector2d way = to_cells - from_cells;
  walk_cells(from_cells + part.begin * way, from_cells + part.end * way, [&](Cell cell, double share) {
    return !geometry.contains(cell) || visit(cell, part.begin + share * (part.end - part.begin));
  });
}

/// How far (m) a ray runs from `origin_m` (map) in the direction `direction_rad` (map; 0 = map x) until it
/// enters an occupied cell: 0 if it starts in one, nothing if it meets none within `max_range_m`. Cells are
/// solid squares; unknown cells and the outside of the grid are transparent. Expects finite arguments.
std::optional<double> cast_ray(const OccupancyGrid& grid, const Eigen::Vector2d& origin_m,
                               double direction_rad, double max_range_m);

/// What a straight way through the map meets.
struct Crossing {
  bool wall = false;     ///< an occupied cell
  bool unknown = false;  ///< an unknown cell
  bool outside = false;  ///< a place beyond the grid

  bool leaves_known_space() const { return unknown || outside; }
  bool free() const { return !wall && !unknown && !outside; }
};

/// What the segment from one map point to another meets, both ends included. A point that is not finite, or
/// is millions of cells away, is outside.
Crossing crosses(const OccupancyGrid& grid, const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m);

/// Whether a beam that ends at `to_m` ends where the map ends: just before the end or `slack_m` behind it
/// lies what the map does not know, and no wall on the way there. Such a beam neither fits the map nor
/// contradicts it.
bool ends_beyond(const OccupancyGrid& grid, const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m,
                 double slack_m);

}  // namespace mstsl
