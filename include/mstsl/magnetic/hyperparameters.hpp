#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace mstsl {

/// What a Gaussian-process regression of the field assumes, per component (map x, y, z): a constant mean, a
/// squared exponential covariance of standard deviation `signal_sd_uT` over `length_scale_m`, and independent
/// noise.
struct FieldHyperparameters {
  Eigen::Array3d mean_uT = Eigen::Array3d::Zero();
  Eigen::Array3d signal_sd_uT = Eigen::Array3d::Constant(7.0);
  Eigen::Array3d length_scale_m = Eigen::Array3d::Constant(1.0);
  Eigen::Array3d noise_sd_uT = Eigen::Array3d::Constant(0.5);
};

/// By name with unit ("length_scale_x_m", "noise_sd_z_uT", ...), as a field map stores them.
std::map<std::string, double> to_named(const FieldHyperparameters& hyperparameters);

/// What to_named() named; nothing where a name is absent or the values are not valid.
std::optional<FieldHyperparameters> from_named(const std::map<std::string, double>& named);

/// Whether all are finite, the scales positive: what a regression can work with.
bool is_valid(const FieldHyperparameters& hyperparameters);

/// Components in groups of the same length scale and noise ratio: each group needs one factorisation only.
std::vector<std::vector<int>> components_by_covariance(const FieldHyperparameters& hyperparameters);

}  // namespace mstsl
