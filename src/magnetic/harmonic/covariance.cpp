#include <cmath>

#include "mstsl/magnetic/harmonic_covariance.hpp"

namespace mstsl {

std::string_view to_string(SourceSide side) {
  switch (side) {
    case SourceSide::kBelow:
      return "below";
    case SourceSide::kAbove:
      return "above";
    case SourceSide::kBoth:
      break;
  }
  return "both";
}

std::vector<std::vector<int>> coupled_components(SourceSide side) {
  if (side == SourceSide::kBoth) return {{0, 1}, {2}};
  return {{0, 1, 2}};
}

Eigen::Array3d HarmonicHyperparameters::component_sd_uT() const {
  return signal_sd_uT * Eigen::Array3d(std::sqrt(0.5), std::sqrt(0.5), 1.0);
}

FieldHyperparameters as_independent(const HarmonicHyperparameters& h) {
  constexpr double kLengthOfDepth = 0.42;  // B_z: (1 - t^2 / 2) / (1 + t^2)^2.5 = exp(-1/2)
  return {h.mean_uT, h.component_sd_uT(), Eigen::Array3d::Constant(kLengthOfDepth * h.depth_m),
          h.noise_sd_uT};
}

Eigen::Matrix3d harmonic_covariance(SourceSide side, double depth_m, const Eigen::Vector2d& difference_m) {
  const double dx = difference_m.x() / depth_m, dy = difference_m.y() / depth_m;
  const double r2 = dx * dx + dy * dy + 1.0, r5 = r2 * r2 * std::sqrt(r2);
  const double xx = 0.5 * (r2 - 3 * dx * dx) / r5, yy = 0.5 * (r2 - 3 * dy * dy) / r5;
  const double xy = -1.5 * dx * dy / r5, zz = 0.5 * (3.0 - r2) / r5;
  const double sign = side == SourceSide::kBelow ? 1.0 : side == SourceSide::kAbove ? -1.0 : 0.0;
  const double xz = sign * 1.5 * dx / r5, yz = sign * 1.5 * dy / r5;
  Eigen::Matrix3d covariance;
  covariance << xx, xy, xz, xy, yy, yz, -xz, -yz, zz;
  return covariance;
}

}  // namespace mstsl
