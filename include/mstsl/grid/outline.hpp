#pragma once

#include <vector>

#include <Eigen/Core>

#include "mstsl/grid/occupancy_grid.hpp"

namespace mstsl {

/// A closed polygon in the map frame, m; the last corner joins the first.
using Polygon = std::vector<Eigen::Vector2d>;

/// The outlines of the occupied regions (8-connected), outer ones counter-clockwise and those of holes
/// clockwise. They pass through the middles of the border cells, where the surface that made the cell
/// occupied is most likely, so a wall one cell thick becomes a line there and back. Simplified after Douglas
/// & Peucker (1973): no border cell's middle is farther than `tolerance_m` from its outline. Negative takes
/// one cell, the least with which the staircase of a straight slanted wall always becomes one line.
std::vector<Polygon> occupied_outlines(const OccupancyGrid& map, double tolerance_m = -1.0);

}  // namespace mstsl
