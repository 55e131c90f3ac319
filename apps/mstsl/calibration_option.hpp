#pragma once

#include <filesystem>
#include <optional>

namespace CLI {
class App;
}

namespace mstsl::app {

/// Adds --calibration to a subcommand that reads a magnetometer; load_calibration() reads it.
void add_calibration_option(CLI::App& command, std::optional<std::filesystem::path>& file);

}  // namespace mstsl::app
