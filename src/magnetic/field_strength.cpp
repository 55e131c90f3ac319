#include "field_strength.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace mstsl {
namespace {

using Eigen::Array3d;
using Eigen::Vector2d;

constexpr double kNodesPerRadius = 3.0, kReach = 3.0;  // of the Gaussian weights, in radii
/// The average counts as much as a tenth of a fingerprint: it takes over where all are three radii away.
constexpr double kAverageWeight = 0.1;

}  // namespace

FieldStrength::FieldStrength(std::span<const Fingerprint> fingerprints, const Array3d& mean_uT,
                             const Array3d& sd_uT, double radius_m)
    : step_m_(radius_m / kNodesPerRadius) {
  if (fingerprints.empty()) return;
  Vector2d high_m = fingerprints.front().position_m;
  low_m_ = high_m;
  for (const Fingerprint& f : fingerprints) {
    low_m_ = low_m_.cwiseMin(f.position_m);
    high_m = high_m.cwiseMax(f.position_m);
  }
  const int reach = static_cast<int>(kReach * kNodesPerRadius) + 1;
  low_m_.array() -= reach * step_m_;
  columns_ = static_cast<int>((high_m.x() - low_m_.x()) / step_m_) + reach + 1;
  rows_ = static_cast<int>((high_m.y() - low_m_.y()) / step_m_) + reach + 1;
  sums_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (const Fingerprint& f : fingerprints) {
    const Vector2d at = (f.position_m - low_m_) / step_m_;
    Sums& nearest = node(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())));
    nearest.weight += 1.0f;
    nearest.squares += static_cast<float>(((f.field_uT.array() - mean_uT) / sd_uT).square().mean());
  }
  blur(reach, true);
  blur(reach, false);
}

void FieldStrength::blur(int nodes, bool along_rows) {
  std::vector<float> weights;
  for (int k = -nodes; k <= nodes; ++k)
    weights.push_back(static_cast<float>(std::exp(-0.5 * std::pow(k / kNodesPerRadius, 2))));
  const int lines = along_rows ? rows_ : columns_, length = along_rows ? columns_ : rows_;
  std::vector<Sums> line(static_cast<std::size_t>(length));
  for (int l = 0; l < lines; ++l) {
    const auto at = [&](int i) -> Sums& { return along_rows ? node(i, l) : node(l, i); };
    std::ranges::fill(line, Sums{});
    for (int i = 0; i < length; ++i) {
      const Sums from = at(i);
      if (from.weight == 0.0f) continue;
      for (int k = std::max(0, i - nodes); k <= std::min(length - 1, i + nodes); ++k) {
        const float w = weights[static_cast<std::size_t>(k - i + nodes)];
        line[static_cast<std::size_t>(k)].weight += w * from.weight;
        line[static_cast<std::size_t>(k)].squares += w * from.squares;
      }
    }
    for (int i = 0; i < length; ++i) at(i) = line[static_cast<std::size_t>(i)];
  }
}

double FieldStrength::at(const Vector2d& map_point_m) const {
  double weight = kAverageWeight, squares = kAverageWeight;
  const Vector2d at = (map_point_m - low_m_) / step_m_;
  if (at.x() >= 0 && at.y() >= 0 && at.x() < columns_ - 1 && at.y() < rows_ - 1) {
    const int column = static_cast<int>(at.x()), row = static_cast<int>(at.y());
    const double x = at.x() - column, y = at.y() - row;
    for (const auto& [dc, dr, share] :
         {std::tuple(0, 0, (1 - x) * (1 - y)), {1, 0, x * (1 - y)}, {0, 1, (1 - x) * y}, {1, 1, x * y}}) {
      const Sums& sums = node(column + dc, row + dr);
      weight += share * static_cast<double>(sums.weight);
      squares += share * static_cast<double>(sums.squares);
    }
  }
  return squares / weight;
}

FieldStrength strength_of(const SurveyAnalysis& survey) {
  const FieldHyperparameters& h = survey.hyperparameters.values;
  const double radius_m = survey.calibration.strength_radius_m;
  if (!(radius_m > 0.0)) return {{}, h.mean_uT, h.signal_sd_uT, 1.0};
  return {survey.fingerprints, h.mean_uT, h.signal_sd_uT, radius_m};
}

LocalCalibration calibrate_locally(std::vector<HeldOutError>& errors,
                                   const std::vector<HeldOutStretch>& stretches,
                                   std::span<const Fingerprint> fingerprints, const Array3d& mean_uT,
                                   const VarianceCalibration& prior, Threads threads) {
  // From where one upright of a rack matters to where a whole hall does.
  constexpr std::array kRadii_m{0.5, 1.0, 2.0};
  LocalCalibration best{prior, kRadii_m.front()};
  std::vector<HeldOutError> best_errors = errors;
  double best_density = -std::numeric_limits<double>::infinity();
  for (const double radius_m : kRadii_m) {
    parallel_for(stretches.size(), threads, [&](std::size_t s) {
      std::vector<Fingerprint> training;
      for (const std::size_t i : stretches[s].training) training.push_back(fingerprints[i]);
      const FieldStrength strength(training, mean_uT, prior.prior_sd_uT, radius_m);
      for (HeldOutError& e : errors)
        if (e.stretch == s) e.strength = strength.at(fingerprints[e.fingerprint].position_m);
    });
    const VarianceCalibration calibration = calibrate(errors, prior);
    if (const double density = mean_log_density(errors, calibration); density > best_density) {
      best_density = density;
      best = {calibration, radius_m};
      best_errors = errors;
    }
  }
  errors = std::move(best_errors);
  return best;
}

}  // namespace mstsl
