#pragma once

#include <filesystem>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/grid/outline.hpp"
#include "mstsl/sim/segment.hpp"

namespace mstsl::datasets {

/// Where people can walk on one floor: inside the outer polygon and outside every block. Metres, map frame.
struct FloorPlan {
  Polygon outer;
  std::vector<Polygon> blocks;
};

/// Reads {"in": [[x, y], ...], "out": [[[x, y], ...], ...]}. Errors: a file that is no such JSON, polygons of
/// fewer than three corners, coordinates that are no finite numbers; the message names the place.
Result<FloorPlan> read_floor_plan(const std::filesystem::path& file);

std::vector<sim::Segment> walls(const FloorPlan& plan);

}  // namespace mstsl::datasets
