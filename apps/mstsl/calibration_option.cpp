#include "calibration_option.hpp"

#include "mstsl/io/calibration_file.hpp"

namespace mstsl::app {

void add_calibration_option(CLI::App& command, std::optional<std::filesystem::path>& file) {
  command.add_option("--calibration", file,
                     "The magnetometer's hard and soft iron, as `mstsl calibrate` finds them");
}

Result<MagnetometerCalibration> load_calibration(const std::optional<std::filesystem::path>& file) {
  if (!file) return MagnetometerCalibration{};
  return io::read_calibration(*file);
}

}  // namespace mstsl::app
