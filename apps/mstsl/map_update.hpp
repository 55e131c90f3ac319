#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/io/recording.hpp"

#include "session.hpp"

namespace mstsl::app {

/// What the user of `mstsl map update` gave.
struct UpdateWish {
  std::filesystem::path map, field;
  std::optional<std::filesystem::path> output;  ///< without it the drives are compared and nothing is written
  std::optional<std::filesystem::path> picture, calibration;
  std::vector<std::filesystem::path> logs;
  io::PlayOptions play;
  std::string initial_pose;  ///< of each log; without it and a pose topic the joint method finds the drives
};

/// Finds the drives on the maps, says where the field has changed, and makes the field map anew of what still
/// holds and what they measured.
Result<Exit> map_update(const Session& session, const UpdateWish& wish);

}  // namespace mstsl::app
