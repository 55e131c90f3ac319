#pragma once

#include <filesystem>

#include "mstsl/core/magnetometer_calibration.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/magnetic/turn_calibration.hpp"

namespace mstsl::io {

/// Reads a magnetometer's calibration: a yaml with `hard_iron_uT` (three numbers) and `soft_iron` (three rows
/// of three), in the sensor's axes; other keys are for people. Errors: keys that are missing or of another
/// kind, numbers that are not finite, a soft iron that no robot has (it mirrors, or scales beyond a third or
/// three).
Result<MagnetometerCalibration> read_calibration(const std::filesystem::path& yaml);

/// Writes what read_calibration() reads, and how well it is known.
Result<void> write_calibration(const TurnCalibration& calibration, const std::filesystem::path& yaml);

}  // namespace mstsl::io
