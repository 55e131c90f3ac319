#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"

namespace mstsl {

/// A cell by column (along the grid's x axis) and row (along its y axis); (0, 0) lies at the grid's origin.
struct Cell {
  int column = 0;
  int row = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

/// How a rectangle of square cells lies in the map frame. Rows are stored one after another, row 0 first.
struct GridGeometry {
  double resolution_m = 0.05;
  int columns = 0;
  int rows = 0;
  Pose2 map_T_grid = {};  ///< the outer corner of cell (0, 0), with the grid's yaw

  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  bool contains(Cell cell) const {
    return cell.column >= 0 && cell.row >= 0 && cell.column < columns && cell.row < rows;
  }
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(cell.column);
  }
  Cell cell(std::size_t index) const {
    return {static_cast<int>(index % static_cast<std::size_t>(columns)),
            static_cast<int>(index / static_cast<std::size_t>(columns))};
  }

  /// The cell that a point of the map falls into; it need not lie inside the grid.
  Cell cell_at(const Eigen::Vector2d& map_point_m) const;
  /// The centre of a cell in the map frame.
  Eigen::Vector2d center_of(Cell cell) const;
  /// A map point in units of cells from the grid's origin: (0.5, 0.5) is the centre of cell (0, 0).
  Eigen::Vector2d to_grid(const Eigen::Vector2d& map_point_m) const;
  Eigen::Vector2d to_map(const Eigen::Vector2d& grid_point_cells) const;
};

bool operator==(const GridGeometry& a, const GridGeometry& b);

}  // namespace mstsl
