#pragma once

#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::sim {

/// The map a careful SLAM run would make of today's world: cells that a surface passes through are occupied, cells of
/// the footprint that can be reached from the lanes are free, all else is unknown. Resolution in m.
OccupancyGrid occupancy_map(const World& world, double resolution_m = 0.05);

}  // namespace mstsl::sim
