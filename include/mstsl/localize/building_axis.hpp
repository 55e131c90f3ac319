#pragma once

#include <optional>

#include "mstsl/grid/occupancy_grid.hpp"

namespace mstsl {

/// The direction of a building's walls in the map frame, in (-pi/4, pi/4]: the x axis of the paper's map body
/// frame, to which corridors are parallel or square. Found as the angle at which the walls, seen along it and
/// across it, fall together most (the sum of the squared counts of their projections); good to a few
/// hundredths of a degree over 10 m of wall. Nothing for a map without walls.
std::optional<double> building_axis(const OccupancyGrid& map);

}  // namespace mstsl
