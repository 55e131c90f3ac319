#include "mstsl/scan/likelihood_field.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "mstsl/grid/distance_field.hpp"

namespace mstsl {
namespace {

constexpr double kReachSigmas = 3.0;
constexpr double kNarrowestCells = 1.5;

/// Catmull-Rom weights of the four samples around a place `t` of the way from the second to the third, and
/// their derivatives by t.
struct CubicWeights {
  std::array<double, 4> value;
  std::array<double, 4> slope;

  explicit CubicWeights(double t)
      : value{t * (-0.5 + t * (1.0 - 0.5 * t)), 1.0 + t * t * (-2.5 + 1.5 * t),
              t * (0.5 + t * (2.0 - 1.5 * t)), t * t * (-0.5 + 0.5 * t)},
        slope{-0.5 + t * (2.0 - 1.5 * t), t * (-5.0 + 4.5 * t), 0.5 + t * (4.0 - 4.5 * t),
              t * (-1.0 + 1.5 * t)} {}
};

}  // namespace

LikelihoodField::LikelihoodField(const OccupancyGrid& occupancy, const LikelihoodOptions& options)
    : values_(occupancy.geometry()),
      frame_(occupancy.geometry()),
      sigma_m_(std::max(options.sigma_m, kNarrowestCells * occupancy.geometry().resolution_m)) {
  assert(options.sigma_m > 0);
  const double reach_m = kReachSigmas * sigma_m_;
  const DistanceField distances(occupancy, reach_m);
  const auto reach_stored_m = static_cast<float>(reach_m);
  for (std::size_t i = 0; i < values_.values().size(); ++i) {
    const float distance_m = distances.values_m().values()[i];
    if (distance_m >= reach_stored_m) continue;
    const double in_sigmas = distance_m / sigma_m_;
    values_.values()[i] = static_cast<float>(std::exp(-0.5 * in_sigmas * in_sigmas));
  }
}

LikelihoodField::Sample LikelihoodField::sample(const Eigen::Vector2d& grid_point_cells) const {
  const double u = grid_point_cells.x() - 0.5, v = grid_point_cells.y() - 0.5;
  const double left = std::floor(u), below = std::floor(v);
  const int columns = geometry().columns, rows = geometry().rows;
  if (!(left >= -2 && below >= -2 && left <= columns && below <= rows)) return {};

  const int column = static_cast<int>(left) - 1, row = static_cast<int>(below) - 1;
  const CubicWeights x(u - left), y(v - below);
  Sample sample;
  for (int r = 0; r < 4; ++r) {
    if (row + r < 0 || row + r >= rows) continue;
    const float* line = values_.values().data() + geometry().index({0, row + r});
    double value = 0, slope = 0;
    for (int c = 0; c < 4; ++c) {
      if (column + c < 0 || column + c >= columns) continue;
      value += x.value[c] * line[column + c];
      slope += x.slope[c] * line[column + c];
    }
    sample.value += y.value[r] * value;
    sample.gradient_per_cell.x() += y.value[r] * slope;
    sample.gradient_per_cell.y() += y.slope[r] * value;
  }
  return sample;
}

}  // namespace mstsl
