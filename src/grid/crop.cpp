#include "mstsl/grid/crop.hpp"

#include <algorithm>
#include <cassert>

#include "mstsl/grid/frame.hpp"

namespace mstsl {

OccupancyGrid crop(const OccupancyGrid& grid, const Eigen::Vector2d& map_center_m, double half_size_m) {
  assert(half_size_m >= 0);
  const GridGeometry& whole = grid.geometry();
  const Eigen::Vector2d center = whole.to_grid(map_center_m);
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(half_size_m / whole.resolution_m);
  const Cell first = GridFrame::cell_of(center - reach), last = GridFrame::cell_of(center + reach);
  const int column = std::clamp(first.column, 0, whole.columns), row = std::clamp(first.row, 0, whole.rows);

  GridGeometry part = whole;
  part.columns = std::clamp(last.column + 1, column, whole.columns) - column;
  part.rows = std::clamp(last.row + 1, row, whole.rows) - row;
  part.map_T_grid = Pose2::from(whole.to_map({static_cast<double>(column), static_cast<double>(row)}),
                                whole.map_T_grid.yaw);

  OccupancyGrid cut(part);
  for (int r = 0; r < part.rows; ++r) {
    for (int c = 0; c < part.columns; ++c) cut[{c, r}] = grid[{column + c, row + r}];
  }
  return cut;
}

}  // namespace mstsl
