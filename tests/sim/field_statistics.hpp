#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "mstsl/sim/world.hpp"

/// How a building's magnetic field varies, measured in one way on simulated worlds and on real recordings.
namespace mstsl::test {

struct FieldSample {
  Eigen::Vector2d position_m;
  Eigen::Vector3d field_uT;
};

/// Samples along one continuous path, in order.
using FieldPath = std::vector<FieldSample>;

struct FieldStatistics {
  Eigen::Vector3d sd_uT;         ///< per axis, about the mean over all paths
  double kurtosis = 0.0;         ///< of the deviations, each axis scaled by its SD; 3 for a Gaussian
  double along_m = 0.0;          ///< lag at which the correlation along the path falls to 0.5
  double across_m = 0.0;         ///< the same between parallel paths; 0 if they lie too near to tell
  double along_at_half_m = 0.0;  ///< correlation at 0.5 m along the path, and between parallel paths
  double across_at_half_m = 0.0;
  std::array<double, 3> gradient_uT_m{};  ///< 5, 50 and 95 % of |dB/ds| along the path, over 0.2 m
  double local_sd_low_uT = 0.0;   ///< 10 % and 90 % of the SD (all axes) within stretches of 5 m: quiet and
  double local_sd_high_uT = 0.0;  ///< strong places
};

FieldStatistics statistics(const std::vector<FieldPath>& paths);

/// The field every 5 cm along lines of a world's lanes, `shift_m` beside their centres, at a height.
std::vector<FieldPath> lane_paths(const sim::World& world, double shift_m, double height_m);

/// Centre lines and lines beside them, 0.2 to 1.2 m apart, for the correlation across.
std::vector<FieldPath> survey_paths(const sim::World& world, double height_m = 0.7);

/// A CSV of the real corridors: x, y, z, bx, by, bz.
FieldPath read_cea(const std::string& file);

}  // namespace mstsl::test
