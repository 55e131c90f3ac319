#include "contaminated_noise.hpp"

#include <cmath>
#include <utility>

namespace mstsl {
namespace {

constexpr double kBadShare = 0.01, kBadTimesTheNoise = 10.0;
constexpr double kBadPrecision = 1.0 / (kBadTimesTheNoise * kBadTimesTheNoise);

double log_odds_of_bad(double squared_deviations, int components) {
  return std::log(kBadShare / (1.0 - kBadShare)) - components * std::log(kBadTimesTheNoise) +
         0.5 * (1.0 - kBadPrecision) * squared_deviations;
}

/// What bad ones add to the log of the density of good ones.
double log_of_tails(double squared_deviations, int components) {
  const double log_odds = log_odds_of_bad(squared_deviations, components);
  const double added =
      log_odds > 0.0 ? log_odds + std::log1p(std::exp(-log_odds)) : std::log1p(std::exp(log_odds));
  return std::log(1.0 - kBadShare) + added;
}

}  // namespace

double noise_weight(double squared_deviations, int components) {
  const double bad = 1.0 / (1.0 + std::exp(-log_odds_of_bad(squared_deviations, components)));
  return 1.0 - bad * (1.0 - kBadPrecision);
}

double contaminated_log_density(const HeldOutError& error, const VarianceCalibration& calibration) {
  const Eigen::Array3d variance = calibration.apply(error.variance_uT2, error.strength);
  const double squared = (error.error_uT.square() / variance).sum();
  return -0.5 * (squared + variance.log().sum()) + log_of_tails(squared, 3);
}

VarianceCalibration calibrate_good_ones(std::span<const HeldOutError> errors,
                                        const VarianceCalibration& prior) {
  constexpr int kRounds = 5;
  std::vector<HeldOutError> good(errors.begin(), errors.end());
  VarianceCalibration calibration = calibrate(good, prior, Tails::kNone);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<HeldOutError> next;
    for (const HeldOutError& e : errors) {
      const double squared = (e.error_uT.square() / calibration.apply(e.variance_uT2, e.strength)).sum();
      if (noise_weight(squared, 3) > 0.5) next.push_back(e);
    }
    if (next.size() == good.size()) break;
    good = std::move(next);
    calibration = calibrate(good, prior, Tails::kNone);
  }
  return calibration;
}

}  // namespace mstsl
