#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "mstsl/core/result.hpp"

namespace mstsl::app {

/// The files of one run that its picture is drawn from.
struct RunFiles {
  std::filesystem::path map;
  std::filesystem::path field;
  std::filesystem::path estimates;
  std::optional<std::filesystem::path> truth;
};

/// Draws map, field, true and estimated path, and the hypotheses that were left a third of the way to the
/// first pose, into a PNG or SVG.
Result<void> write_run_picture(const RunFiles& files, const std::string& title,
                               const std::filesystem::path& picture);

}  // namespace mstsl::app
