#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/sensor_data.hpp"

namespace mstsl {

/// Holds the last field readings before odometry began anew against the first after it: a robot that stood
/// still meanwhile, whatever its bias, reads the same.
class RestartWatch {
 public:
  struct Jump {
    Stamp stamp;             ///< of the first reading after the restart
    double change_uT = 0.0;  ///< length of the difference
  };

  void observe(const FieldReading& reading);
  void observe(const OdometryRestart&) { after_.emplace(); }

  /// Restarts at which the field changed by more than twice what a few centimetres make beside steel.
  const std::vector<Jump>& jumps() const { return jumps_; }

 private:
  static constexpr std::size_t kReadings = 20;  ///< averaged: 0.2 s of a usual magnetometer
  std::deque<Eigen::Vector3d> before_;
  std::optional<std::vector<Eigen::Vector3d>> after_;  ///< while readings after a restart are gathered
  std::vector<Jump> jumps_;
};

}  // namespace mstsl
