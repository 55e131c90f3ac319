#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/mapping/occupancy_mapper.hpp"
#include "mstsl/mapping/slam.hpp"

#include "session.hpp"

namespace mstsl::app {

/// What the user of `mstsl map occupancy` gave.
struct OccupancyMapWish {
  std::filesystem::path output;
  std::vector<std::filesystem::path> logs;
  io::PlayOptions play;
  MappingOptions drawing;
  SlamOptions slam;
  bool without_field = false;
  std::string truth_topic;  ///< poses to hold the map's against; they are not used to make it
  std::optional<std::filesystem::path> tum;
  std::optional<std::filesystem::path> report;
  std::optional<std::filesystem::path> picture;
};

/// A map, and the drive that made it.
struct MappedDrive {
  OccupancyGrid grid;
  SlamTrack track;
  std::vector<std::string> warnings;
  std::vector<PoseReading> truth;  ///< what the log says under the truth's topic
};

/// Finds where the robot was, then draws what its scans saw from there. The logs are one drive: each begins
/// where the one before ended.
Result<MappedDrive> map_drive(const Session& session, const OccupancyMapWish& wish);

/// Maps, writes and reports.
Result<Exit> map_occupancy(const Session& session, const OccupancyMapWish& wish);

}  // namespace mstsl::app
