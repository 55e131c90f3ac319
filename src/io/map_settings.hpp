#pragma once

#include <string>

#include "mstsl/core/pose2.hpp"

namespace mstsl::io {

// What map_saver writes.
inline constexpr double kOccupiedThreshold = 0.65;
inline constexpr double kFreeThreshold = 0.196;

/// How map_server turns a pixel's occupancy into a cell.
enum class MapMode { kTrinary, kScale, kRaw };

/// What a map_server yaml says.
struct MapSettings {
  std::string image;
  double resolution_m = 0.0;
  Pose2 map_T_grid;
  bool negate = false;
  double occupied_threshold = kOccupiedThreshold;
  double free_threshold = kFreeThreshold;
  MapMode mode = MapMode::kTrinary;
};

/// Throws FileProblem where a key is missing, of another type or out of its range.
MapSettings parse_map_settings(const std::string& yaml);

}  // namespace mstsl::io
