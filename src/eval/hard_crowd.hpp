#pragma once

#include <vector>

#include "mstsl/core/random.hpp"
#include "mstsl/core/sensor_data.hpp"

namespace mstsl {

/// People who walk along with the robot, as visitors do, and hide beams: up to 30 % in the open; less in a
/// narrow corridor, where the walls stand nearer.
class Crowd {
 public:
  Crowd(double share_of_beams, const LaserScan& like, const Random& random);
  /// Puts them in front of what the scan saw.
  void hide(LaserScan& scan, double seconds);

 private:
  struct Walker {
    double angle_rad, range_m;  ///< where they keep to, seen from the laser
    double sway_rad, sway_s, phase_rad;
  };
  std::vector<Walker> walkers_;
  Random random_;
};

}  // namespace mstsl
