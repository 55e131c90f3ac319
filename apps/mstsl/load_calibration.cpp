#include "load_calibration.hpp"

#include "mstsl/io/calibration_file.hpp"

namespace mstsl::app {

Result<MagnetometerCalibration> load_calibration(const std::optional<std::filesystem::path>& file) {
  if (!file) return MagnetometerCalibration{};
  return io::read_calibration(*file);
}

}  // namespace mstsl::app
