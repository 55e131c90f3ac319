#include "choose_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "mstsl/magnetic/predictors.hpp"

#include "contaminated_noise.hpp"
#include "harmonic/dense.hpp"
#include "harmonic/learn.hpp"
#include "noise_by_lane.hpp"

namespace mstsl {
namespace {

using Eigen::Array3d;

/// What one covariance makes of the held-out stretches.
struct Trial {
  double mean_log_density = -std::numeric_limits<double>::infinity();
  std::vector<double> log_density;  ///< of each stretch, mean over its fingerprints
  Array3d rms_uT = Array3d::Zero();
};

Trial tried(std::span<const Fingerprint> fingerprints, const std::vector<HeldOutStretch>& stretches,
            const Predictor& predict, const FieldHyperparameters& h, Threads threads) {
  std::vector<std::vector<HeldOutError>> errors(stretches.size());
  parallel_for(stretches.size(), threads, [&](std::size_t s) {
    errors[s] = held_out_errors(fingerprints, {stretches[s]}, predict, Threads{1});
  });
  std::vector<HeldOutError> all;
  for (const auto& part : errors) all.insert(all.end(), part.begin(), part.end());
  if (all.empty()) return {};
  const VarianceCalibration calibration =
      calibrate_good_ones(all, uncalibrated(h.noise_sd_uT, h.signal_sd_uT));
  Trial trial;
  trial.rms_uT = score(all, calibration).rms_uT;
  trial.mean_log_density = 0.0;
  for (const auto& part : errors) {
    double sum = 0.0;
    for (const HeldOutError& e : part) sum += contaminated_log_density(e, calibration);
    trial.mean_log_density += sum / static_cast<double>(all.size());
    trial.log_density.push_back(part.empty() ? 0.0 : sum / static_cast<double>(part.size()));
  }
  return trial;
}

/// Both ways of leaving out, half of the usual stretches each: a choice needs fewer than a calibration.
std::vector<HeldOutStretch> stretches_of(std::span<const Fingerprint> fingerprints, double length_m) {
  HoldOutWays ways = hold_out_ways(length_m, 0.5 * length_m);
  std::vector<HeldOutStretch> all;
  for (HoldOutOptions* way : {&ways.same_floor, &ways.between_lanes}) {
    way->stretches /= 2;
    way->training = kHarmonicTraining;
    for (HeldOutStretch& stretch : hold_out_lanes(fingerprints, *way)) all.push_back(std::move(stretch));
  }
  return all;
}

/// The noise is raised to what foretells the stretches best, as for independent components.
std::pair<HarmonicHyperparameters, Trial> best_noise(std::span<const Fingerprint> fingerprints,
                                                     const std::vector<HeldOutStretch>& stretches,
                                                     HarmonicHyperparameters h, Threads threads) {
  std::pair<HarmonicHyperparameters, Trial> best{h, {}};
  for (; (h.noise_sd_uT <= h.signal_sd_uT).all(); h.noise_sd_uT *= std::numbers::sqrt2) {
    Trial trial = tried(fingerprints, stretches, harmonic_predictor(h), as_independent(h), threads);
    if (!(trial.mean_log_density > best.second.mean_log_density)) break;
    best = {h, std::move(trial)};
  }
  return best;
}

}  // namespace

std::optional<KernelComparison> compare_kernels(std::span<const Fingerprint> fingerprints,
                                                const FieldHyperparameters& independent,
                                                const LearningOptions& learning) {
  const auto learned = learn_harmonic(fingerprints, independent, learning);
  if (!learned) return std::nullopt;
  const auto stretches = stretches_of(fingerprints, independent.length_scale_m.maxCoeff());
  const Trial before =
      tried(fingerprints, stretches, gpr_predictor(independent), independent, learning.threads);
  auto [harmonic, after] = best_noise(fingerprints, stretches, *learned, learning.threads);
  const std::size_t n = before.log_density.size();
  if (n < 2 || after.log_density.size() != n) return std::nullopt;
  std::vector<double> gains(n);
  for (std::size_t s = 0; s < n; ++s) gains[s] = after.log_density[s] - before.log_density[s];
  KernelComparison comparison{harmonic, 0.0, 0.0, before.rms_uT, after.rms_uT};
  comparison.gain = std::accumulate(gains.begin(), gains.end(), 0.0) / static_cast<double>(n);
  for (const double gain : gains) comparison.gain_sd += std::pow(gain - comparison.gain, 2);
  comparison.gain_sd = std::sqrt(comparison.gain_sd / static_cast<double>(n * (n - 1)));
  return comparison;
}

}  // namespace mstsl
