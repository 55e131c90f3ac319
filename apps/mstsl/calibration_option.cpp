#include "calibration_option.hpp"

#include <CLI/CLI.hpp>

namespace mstsl::app {

void add_calibration_option(CLI::App& command, std::optional<std::filesystem::path>& file) {
  command.add_option("--calibration", file,
                     "The magnetometer's hard and soft iron, as `mstsl calibrate` finds them");
}

}  // namespace mstsl::app
