#pragma once

#include <filesystem>

#include "mstsl/core/result.hpp"

namespace mstsl::app {

/// The files of one run that its picture is drawn from.
struct RunFiles {
  std::filesystem::path map;
  std::filesystem::path field;
  std::filesystem::path truth;
  std::filesystem::path estimates;
};

/// Draws map, field, true and estimated path, and the initial hypotheses into a PNG.
Result<void> write_run_picture(const RunFiles& files, const std::filesystem::path& png);

}  // namespace mstsl::app
