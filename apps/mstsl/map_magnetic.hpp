#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"

#include "session.hpp"

namespace mstsl::app {

/// What the user of `mstsl map magnetic` gave.
struct MagneticMapWish {
  std::filesystem::path map;
  std::filesystem::path output;
  std::vector<std::filesystem::path> logs;
  std::vector<std::filesystem::path> checks;
  io::PlayOptions play;
  std::string initial_pose;
  std::string model = "gpr";
  std::string kernel = "auto";
  std::string quality = "fast";
  std::string bias = "auto";
  std::optional<std::filesystem::path> calibration;
  std::optional<std::filesystem::path> picture;
  FieldMapOptions build;
};

/// Reads the survey, builds the map, checks, writes and reports it.
Result<Exit> map_magnetic(const Session& session, const MagneticMapWish& wish);

}  // namespace mstsl::app
