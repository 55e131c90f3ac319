#include "mstsl/grid/occupancy_grid.hpp"

#include <algorithm>

namespace mstsl {

CellState state_at(const OccupancyGrid& grid, const Eigen::Vector2d& map_point_m) {
  const Cell cell = grid.geometry().cell_at(map_point_m);
  return grid.contains(cell) ? grid[cell] : CellState::kUnknown;
}

std::size_t count(const OccupancyGrid& grid, CellState state) {
  return static_cast<std::size_t>(std::count(grid.values().begin(), grid.values().end(), state));
}

}  // namespace mstsl
