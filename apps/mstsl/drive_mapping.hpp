#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/mapping/occupancy_mapper.hpp"
#include "mstsl/mapping/slam.hpp"

#include "session.hpp"

namespace mstsl::app {

/// The drives that a map is to be made of.
struct DrivesWish {
  std::vector<std::filesystem::path> logs;
  io::PlayOptions play;
  /// Each log begins where the one before ended: all are one drive. Otherwise each is a drive of its own,
  /// found in the map of those before it.
  bool continuous = false;
  bool without_field = false;
  std::string truth_topic;  ///< poses to hold the map's against; they are not used to make it
  MappingOptions drawing;
  SlamOptions slam;
};

/// A map, and the drives that made it.
struct MappedDrives {
  OccupancyGrid grid;
  SlamTrack track;
  io::PlayOptions play;  ///< what the logs have of what was asked for
  std::vector<std::string> warnings;
  std::vector<std::vector<PoseReading>> truth;  ///< of each drive, under the truth's topic
};

/// Finds where the robot was on each drive, then draws what its scans saw from there. Errors: a log that
/// cannot be read or mapped, or not be found in the map of those before it; an interrupt.
Result<MappedDrives> map_drives(const Session& session, const DrivesWish& wish);

}  // namespace mstsl::app
