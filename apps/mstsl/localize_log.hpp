#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mstsl/io/recording.hpp"
#include "mstsl/localize/methods.hpp"

#include "session.hpp"

namespace mstsl::app {

/// What the user of `mstsl localize` gave.
struct LocalizeWish {
  std::filesystem::path map;
  std::filesystem::path field;
  std::string method = "joint";
  std::size_t hypotheses = DistinctOptions{}.count;
  double localized_from = JointOptions{}.localized_from;
  std::filesystem::path output;
  std::optional<std::filesystem::path> tum, picture, report, truth;
  std::optional<std::filesystem::path> calibration;
  std::vector<std::filesystem::path> logs;
  io::PlayOptions play;
};

/// Plays the logs to the method and writes what it says.
Result<Exit> localize_log(const Session& session, const LocalizeWish& wish);

}  // namespace mstsl::app
