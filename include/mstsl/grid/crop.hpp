#pragma once

#include <Eigen/Core>

#include "mstsl/grid/occupancy_grid.hpp"

namespace mstsl {

/// The paper's submap M_G,s: the cells of a map within `half_size_m` of a point (along the grid's own axes),
/// as a grid that lies where they lie. Parts beyond the map are left out, so it may be smaller than asked,
/// and even empty. Expects a finite centre and half_size_m >= 0.
OccupancyGrid crop(const OccupancyGrid& grid, const Eigen::Vector2d& map_center_m, double half_size_m);

}  // namespace mstsl
