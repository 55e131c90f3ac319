#pragma once

#include <Eigen/Core>
#include <vector>

#include "mstsl/grid/occupancy_grid.hpp"

namespace mstsl {

/// A closed polygon in the map frame, m; the last corner joins the first.
using Polygon = std::vector<Eigen::Vector2d>;

/// The boundaries of the occupied regions (4-connected), traced along the cells' edges with the occupied side on the
/// left and simplified by Douglas & Peucker (1973) to `tolerance_m`; negative takes half a cell.
std::vector<Polygon> occupied_outlines(const OccupancyGrid& map, double tolerance_m = -1.0);

}  // namespace mstsl
