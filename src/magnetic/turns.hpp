#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/sensor_data.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/magnetic/turn_calibration.hpp"

namespace mstsl {

/// The field at one heading of one turn on the spot, base frame: the mean of the readings in 10 deg.
struct TurnSample {
  Eigen::Vector3d base_field_uT = Eigen::Vector3d::Zero();
  std::size_t readings = 0;
  int heading = 0;       ///< in steps of 10 deg
  std::size_t turn = 0;  ///< which turn, from 0
};

inline constexpr int kHeadings = 36;

/// Finds the turns on the spot in one drive and appends their samples; `turn` counts on from `turns`, which
/// grows by those found.
void find_turns(const Trajectory& odom_T_base, std::span<const FieldReading> readings,
                const Eigen::Matrix3d& base_R_sensor, const TurnCalibrationOptions& options,
                std::vector<TurnSample>& samples, std::size_t& turns);

}  // namespace mstsl
