#pragma once

#include <filesystem>
#include <optional>

#include <CLI/CLI.hpp>

#include "mstsl/core/magnetometer_calibration.hpp"
#include "mstsl/core/result.hpp"

namespace mstsl::app {

/// Adds --calibration to a subcommand that reads a magnetometer.
void add_calibration_option(CLI::App& command, std::optional<std::filesystem::path>& file);

/// What the file says; no change to the readings without one.
Result<MagnetometerCalibration> load_calibration(const std::optional<std::filesystem::path>& file);

}  // namespace mstsl::app
