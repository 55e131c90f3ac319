#pragma once

#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::sim {

/// The map a careful SLAM run would make of today's world: cells that a surface passes through are occupied,
/// cells of the footprint that can be reached from the lanes are free, all else is unknown. A world that was
/// made from a map of this resolution gives back that map. Resolution in m.
OccupancyGrid occupancy_map(const World& world, double resolution_m = 0.05);

}  // namespace mstsl::sim
