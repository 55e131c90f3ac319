#pragma once

#include <cstdint>

#include "mstsl/grid/grid.hpp"

namespace mstsl {

/// What is known of a cell: map_server's trinary reading.
enum class CellState : std::uint8_t { kFree, kOccupied, kUnknown };

using OccupancyGrid = Grid<CellState>;

/// The state at a point of the map; unknown outside the grid.
CellState state_at(const OccupancyGrid& grid, const Eigen::Vector2d& map_point_m);

std::size_t count(const OccupancyGrid& grid, CellState state);

}  // namespace mstsl
