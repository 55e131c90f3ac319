#include "mstsl/grid/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace mstsl {
namespace {

/// Far outside any grid, yet safe to convert: a NaN or a huge coordinate falls into no cell.
int to_cell_index(double coordinate_cells) {
  constexpr double kFar = 1e9;
  if (!(std::abs(coordinate_cells) < kFar))
    return coordinate_cells > 0 ? static_cast<int>(kFar) : -static_cast<int>(kFar);
  return static_cast<int>(std::floor(coordinate_cells));
}

}  // namespace

Cell GridGeometry::cell_at(const Eigen::Vector2d& map_point_m) const {
  const Eigen::Vector2d p = to_grid(map_point_m);
  return {to_cell_index(p.x()), to_cell_index(p.y())};
}

Eigen::Vector2d GridGeometry::center_of(Cell cell) const {
  return to_map({cell.column + 0.5, cell.row + 0.5});
}

Eigen::Vector2d GridGeometry::to_grid(const Eigen::Vector2d& map_point_m) const {
  return map_T_grid.rotation().transpose() * (map_point_m - map_T_grid.position()) / resolution_m;
}

Eigen::Vector2d GridGeometry::to_map(const Eigen::Vector2d& grid_point_cells) const {
  return map_T_grid * Eigen::Vector2d(grid_point_cells * resolution_m);
}

bool operator==(const GridGeometry& a, const GridGeometry& b) {
  return a.resolution_m == b.resolution_m && a.columns == b.columns && a.rows == b.rows &&
         a.map_T_grid.x == b.map_T_grid.x && a.map_T_grid.y == b.map_T_grid.y &&
         a.map_T_grid.yaw == b.map_T_grid.yaw;
}

}  // namespace mstsl
