#include "mstsl/datasets/dataset.hpp"

namespace mstsl::datasets {

sim::RobotOptions robot_with_real_magnetometer() {
  sim::RobotOptions robot;
  robot.magnetometer.noise_uT = 0.0;
  robot.magnetometer.bias_sigma_uT = 0.0;
  return robot;
}

}  // namespace mstsl::datasets
