#pragma once

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/grid/occupancy_grid.hpp"

namespace mstsl::test {

/// A grid that lies anywhere, turned anyhow, with each cell occupied or unknown by chance.
inline OccupancyGrid random_grid(Random& random, int columns, int rows, double share_occupied,
                                 double share_unknown = 0) {
  const Pose2 map_T_grid{random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-kPi, kPi)};
  OccupancyGrid grid({.resolution_m = 0.1, .columns = columns, .rows = rows, .map_T_grid = map_T_grid},
                     CellState::kFree);
  for (CellState& state : grid.values()) {
    const double u = random.uniform();
    if (u < share_occupied) state = CellState::kOccupied;
    if (u > 1 - share_unknown) state = CellState::kUnknown;
  }
  return grid;
}

/// A map point over the grid, or up to `beyond_cells` outside of it.
inline Eigen::Vector2d random_point(Random& random, const GridGeometry& geometry, double beyond_cells = 0) {
  return geometry.to_map({random.uniform(-beyond_cells, geometry.columns + beyond_cells),
                          random.uniform(-beyond_cells, geometry.rows + beyond_cells)});
}

}  // namespace mstsl::test
