#include "mstsl/scan/score.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mstsl/grid/frame.hpp"
#include "mstsl/grid/ray.hpp"

namespace mstsl {
namespace {

/// How far (cells) a coordinate is outside of the cell with this index.
double outside_of(double coordinate_cells, int index) {
  return std::max({0.0, index - coordinate_cells, coordinate_cells - (index + 1)});
}

bool is_near_occupied(const OccupancyGrid& map, const Eigen::Vector2d& at_cells, double tolerance_cells) {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(tolerance_cells);
  const Cell first = GridFrame::cell_of(at_cells - reach), last = GridFrame::cell_of(at_cells + reach);
  for (int row = std::max(first.row, 0); row <= std::min(last.row, map.geometry().rows - 1); ++row) {
    for (int column = std::max(first.column, 0); column <= std::min(last.column, map.geometry().columns - 1);
         ++column) {
      if (map[{column, row}] != CellState::kOccupied) continue;
      if (std::hypot(outside_of(at_cells.x(), column), outside_of(at_cells.y(), row)) <= tolerance_cells)
        return true;
    }
  }
  return false;
}

}  // namespace

double confidence_score(const OccupancyGrid& map, const PointSet& points_base_m, const Pose2& map_T_base,
                        const ScoreOptions& options) {
  const GridFrame frame(map.geometry());
  const double tolerance_cells = options.hit_tolerance_m / map.geometry().resolution_m;
  const Eigen::Matrix2d rotation = map_T_base.rotation();
  std::size_t points = 0, hits = 0, not_asked = 0;
  for (const Eigen::Vector2d& p : points_base_m) {
    if (p.norm() > options.max_range_m) continue;
    ++points;
    const Eigen::Vector2d at_m = rotation * p + map_T_base.position();
    if (is_near_occupied(map, frame.to_grid(at_m), tolerance_cells))
      ++hits;
    else if (!options.unmapped_is_miss && ends_beyond(map, map_T_base.position(), at_m, 0.0))
      ++not_asked;
  }
  if (points == 0) return 0.0;
  const double judged = std::max(static_cast<double>(points - not_asked),
                                 options.least_judged_share * static_cast<double>(points));
  return judged > 0.0 ? static_cast<double>(hits) / judged : 0.0;
}

}  // namespace mstsl
