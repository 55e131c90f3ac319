#pragma once

#include <cmath>

#include <Eigen/Core>

#include "mstsl/grid/geometry.hpp"

namespace mstsl {

/// A GridGeometry with its rotation worked out once, for loops over many points: the same answers as the
/// geometry's own functions without a sine and a cosine at each call.
class GridFrame {
 public:
  explicit GridFrame(const GridGeometry& geometry)
      : geometry_(geometry),
        grid_R_map_cells_(geometry.map_T_grid.rotation().transpose() / geometry.resolution_m),
        map_R_grid_m_(geometry.map_T_grid.rotation() * geometry.resolution_m),
        origin_m_(geometry.map_T_grid.position()) {}

  const GridGeometry& geometry() const { return geometry_; }

  /// A map point (m) in units of cells from the grid's origin.
  Eigen::Vector2d to_grid(const Eigen::Vector2d& map_point_m) const {
    return grid_R_map_cells_ * (map_point_m - origin_m_);
  }
  Eigen::Vector2d to_map(const Eigen::Vector2d& grid_point_cells) const {
    return map_R_grid_m_ * grid_point_cells + origin_m_;
  }

  /// A displacement, which has a direction and a length but no place: map (m) to grid (cells) and back.
  Eigen::Vector2d vector_to_grid(const Eigen::Vector2d& map_vector_m) const {
    return grid_R_map_cells_ * map_vector_m;
  }
  Eigen::Vector2d vector_to_map(const Eigen::Vector2d& grid_vector_cells) const {
    return map_R_grid_m_ * grid_vector_cells;
  }
  /// The slope of a value along the grid's axes (per cell) as the slope along the map's (per m).
  Eigen::Vector2d slope_to_map(const Eigen::Vector2d& slope_per_cell) const {
    return grid_R_map_cells_.transpose() * slope_per_cell;
  }

  /// The cell of a map point; it need not lie inside the grid.
  Cell cell_at(const Eigen::Vector2d& map_point_m) const { return cell_of(to_grid(map_point_m)); }
  Eigen::Vector2d center_of(Cell cell) const { return to_map({cell.column + 0.5, cell.row + 0.5}); }

  /// The cell of a point given in cells. A NaN or a huge coordinate falls far outside any grid, never into a
  /// cell.
  static Cell cell_of(const Eigen::Vector2d& grid_point_cells) {
    return {index_of(grid_point_cells.x()), index_of(grid_point_cells.y())};
  }

 private:
  static int index_of(double coordinate_cells) {
    constexpr double kFar = 1e9;
    if (!(std::abs(coordinate_cells) < kFar))
      return coordinate_cells > 0 ? static_cast<int>(kFar) : -static_cast<int>(kFar);
    return static_cast<int>(std::floor(coordinate_cells));
  }

  GridGeometry geometry_;
  Eigen::Matrix2d grid_R_map_cells_;
  Eigen::Matrix2d map_R_grid_m_;
  Eigen::Vector2d origin_m_;
};

}  // namespace mstsl
