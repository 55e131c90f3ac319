#pragma once

#include <vector>

#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::sim {

/// The direction of most walls, in [-45, 45) deg: their doubled-twice angles, averaged by length.
double main_direction(const std::vector<Segment>& walls);

/// Centre lines of a map's corridors and rooms along both directions of the building: the free space is cut
/// across every 0.2 m, the cuts' middles are linked where they line up, and long enough links become lanes.
std::vector<Lane> lanes_of_map(const OccupancyGrid& map, const SegmentIndex& walls, double axis_yaw_rad);

}  // namespace mstsl::sim
