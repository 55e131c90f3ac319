#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "mstsl/magnetic/hyperparameters.hpp"

/// The field as physics has it: off the steel it is minus the gradient of a potential that is harmonic, so
/// that its three components are one random function and not three. Sources far below or above the plane of
/// the magnetometer make
///   phi ~ GP(0, D^3 / 2 s^2 / sqrt(dx^2 + dy^2 + D^2)),   D = twice their distance,
/// the one isotropic covariance that stays of its form when it is continued upwards (the field of a random
/// sheet of poles). Differentiated twice it is that of the field: B_z has variance s^2, B_x and B_y half of
/// it, and B_z is correlated with the slope of the horizontal ones, with opposite signs for sources below and
/// above.
namespace mstsl {

/// Where the steel is, seen from the magnetometer.
/// Field maps hold the numbers of these.
enum class SourceSide : std::uint8_t {
  kBelow,
  kAbove,
  kBoth  ///< as much below as above: B_z is then independent of the horizontal components
};
std::string_view to_string(SourceSide side);

/// Components that are correlated with each other and with no others, in order.
std::vector<std::vector<int>> coupled_components(SourceSide side);

/// Least noise, as a share of signal_sd: fingerprints that lie a centimetre off cost as much.
inline constexpr double kMinHarmonicNoise = 0.01;

struct HarmonicHyperparameters {
  SourceSide side = SourceSide::kBoth;
  double depth_m = 2.0;       ///< D
  double signal_sd_uT = 8.0;  ///< s, the standard deviation of B_z
  Eigen::Array3d mean_uT = Eigen::Array3d::Zero();
  Eigen::Array3d noise_sd_uT = Eigen::Array3d::Constant(0.5);

  /// Standard deviation of each component.
  Eigen::Array3d component_sd_uT() const;
};

/// The same field to those who know squared exponentials only: its spread, its noise, and the length at which
/// its correlation has fallen to exp(-1/2).
FieldHyperparameters as_independent(const HarmonicHyperparameters& hyperparameters);

/// Covariance of the field at two points, 3 x 3 in units of signal_sd^2: row: component at the first point,
/// column: at the second. Takes the first minus the second point.
Eigen::Matrix3d harmonic_covariance(SourceSide side, double depth_m, const Eigen::Vector2d& difference_m);

}  // namespace mstsl
