#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/grid/occupancy_grid.hpp"

namespace mstsl::io {

/// A map as read, and what its reader should know of it: one clear sentence each.
struct MapFile {
  OccupancyGrid grid;
  std::filesystem::path image;
  std::vector<std::string> warnings;
};

/// Reads a ROS map_server map: a yaml with `image` (PGM, PNG or BMP; relative to the yaml), `resolution` (m),
/// `origin` [x, y, yaw] (m, rad), `negate`, `occupied_thresh`, `free_thresh` and optionally `mode`.
///
/// A pixel's occupancy is (255 - v) / 255, or v / 255 with `negate`, v being the mean over its channels;
/// above occupied_thresh it is occupied, below free_thresh free, else unknown. As in map_server and
/// nav2_map_server, alpha counts as a channel in mode trinary, and a pixel not opaque is unknown in mode
/// scale; mode raw holds percents, 0 to 100, else unknown. What scale and raw have between the thresholds
/// becomes unknown, with a warning. The image's top row is the grid's last.
///
/// Errors: files that are absent or cut off; keys that are missing or of another type; a resolution that is
/// not positive; sizes that no map has; a map without a free cell.
Result<MapFile> read_map_file(const std::filesystem::path& yaml);

/// The grid of `read_map_file`.
Result<OccupancyGrid> read_map(const std::filesystem::path& yaml);

/// Writes `NAME.yaml` and, beside it, `NAME.pgm`, which map_server and read_map() read back identically.
/// Errors: a full disk, a name that does not end in .yaml or .yml, an empty grid.
Result<void> write_map(const OccupancyGrid& grid, const std::filesystem::path& yaml);

}  // namespace mstsl::io
