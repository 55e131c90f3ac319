#include "noise_by_lane.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "mstsl/magnetic/predictors.hpp"

#include "contaminated_noise.hpp"

namespace mstsl {
namespace {

/// Mean log density of held-out errors under the calibration that suits them best.
double best_log_density(std::span<const HeldOutError> errors, const FieldHyperparameters& h) {
  const VarianceCalibration calibration =
      calibrate_good_ones(errors, uncalibrated(h.noise_sd_uT, h.signal_sd_uT));
  double sum = 0.0;
  for (const HeldOutError& e : errors) sum += contaminated_log_density(e, calibration);
  return errors.empty() ? 0.0 : sum / static_cast<double>(errors.size());
}

}  // namespace

HoldOutWays hold_out_ways(double length_m, double radius_m) {
  HoldOutWays ways;
  ways.same_floor.length_m = ways.between_lanes.length_m = length_m;
  ways.between_lanes.radius_m = radius_m;
  return ways;
}

FieldHyperparameters noise_from_lanes(std::span<const Fingerprint> fingerprints,
                                      const FieldHyperparameters& learned, Threads threads) {
  constexpr double kStep = std::numbers::sqrt2, kMostNoise = 1.0;
  const double length_m = learned.length_scale_m.maxCoeff();
  HoldOutWays ways = hold_out_ways(length_m, 0.5 * length_m);
  ways.same_floor.training = ways.between_lanes.training = 300;  // enough to compare, at a fifth of the work
  const auto same_floor = hold_out_lanes(fingerprints, ways.same_floor);
  const auto between = hold_out_lanes(fingerprints, ways.between_lanes);
  FieldHyperparameters best = learned;
  double best_density = -std::numeric_limits<double>::infinity();
  for (FieldHyperparameters h = learned; (h.noise_sd_uT <= kMostNoise * h.signal_sd_uT).all();
       h.noise_sd_uT *= kStep) {
    auto errors = held_out_errors(fingerprints, same_floor, gpr_predictor(h), threads);
    const auto more = held_out_errors(fingerprints, between, gpr_predictor(h), threads);
    errors.insert(errors.end(), more.begin(), more.end());
    const double density = best_log_density(errors, h);
    if (!(density > best_density)) break;  // one maximum: more noise is only worse from here
    best_density = density;
    best = h;
  }
  return best;
}

}  // namespace mstsl
