#pragma once

#include <filesystem>
#include <optional>

#include "mstsl/core/result.hpp"

#include "drive_mapping.hpp"
#include "session.hpp"

namespace mstsl::app {

/// What the user of `mstsl map occupancy` gave.
struct OccupancyMapWish {
  DrivesWish drives;
  std::filesystem::path output;
  std::optional<std::filesystem::path> tum;
  std::optional<std::filesystem::path> report;
  std::optional<std::filesystem::path> picture;
};

/// Maps, writes and reports.
Result<Exit> map_occupancy(const Session& session, const OccupancyMapWish& wish);

/// What the user of `mstsl map all` gave.
struct WholeMapWish {
  DrivesWish drives;
  std::filesystem::path folder;
};

/// Both maps from raw logs: map.yaml, field.nc, the ways driven, pictures and a report in one folder.
Result<Exit> map_all(const Session& session, const WholeMapWish& wish);

}  // namespace mstsl::app
