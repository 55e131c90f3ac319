#pragma once

#include "mstsl/core/result.hpp"
#include "mstsl/eval/mapping_protocol.hpp"
#include "mstsl/grid/occupancy_grid.hpp"

#include "mapping_drive.hpp"

namespace mstsl {

/// Maps a drive and holds the map against the truth; world, robot and run are the caller's. Errors: those of
/// Slam::track().
Result<MappingRecord> map_drive(const Recording& recording, const OccupancyGrid& true_map, bool with_field);

}  // namespace mstsl
