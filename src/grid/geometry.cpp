#include "mstsl/grid/geometry.hpp"

#include "mstsl/grid/frame.hpp"

namespace mstsl {

Cell GridGeometry::cell_at(const Eigen::Vector2d& map_point_m) const {
  return GridFrame::cell_of(to_grid(map_point_m));
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
