#pragma once

#include <filesystem>
#include <optional>

#include "mstsl/core/magnetometer_calibration.hpp"
#include "mstsl/core/result.hpp"

namespace mstsl::app {

/// What the file of --calibration says; no change to the readings without one.
Result<MagnetometerCalibration> load_calibration(const std::optional<std::filesystem::path>& file);

}  // namespace mstsl::app
