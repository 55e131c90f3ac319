#include "learn.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "mstsl/magnetic/gaussian_process.hpp"

#include "../learning_blocks.hpp"
#include "../maximise.hpp"
#include "dense.hpp"

namespace mstsl {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// As learn_hyperparameters.cpp has it for independent components: the depth is that length scale over 0.42,
/// the noise relative to B_z.
struct Prior {
  double median, log_sd, low, high;
};
constexpr Prior kDepth_m{1.9, 0.8, 0.4, 14.0};
constexpr Prior kNoiseRatio{0.08, 1.2, kMinHarmonicNoise, 2.0};
constexpr std::array<Prior, 3> kPriors{kDepth_m, kNoiseRatio, kNoiseRatio};

/// Logs of depth, horizontal and vertical noise ratio.
HarmonicHyperparameters with(HarmonicHyperparameters h, const VectorXd& logs) {
  h.depth_m = std::exp(logs(0));
  const double horizontal = std::exp(logs(1)), vertical = std::exp(logs(2));
  h.noise_sd_uT = h.signal_sd_uT * Eigen::Array3d(horizontal, horizontal, vertical);
  return h;
}

/// Log marginal likelihood of some components of a block, and its gradient by the logs (R&W Eq. 2.30, 5.9).
/// Matrices hold those components only, one after the other.
Objective log_likelihood(MatrixXd covariance, const MatrixXd& by_log_depth, const VectorXd& noise_variance,
                         const VectorXd& values, const std::vector<int>& components) {
  Objective objective{std::numeric_limits<double>::quiet_NaN(), VectorXd::Zero(3)};
  covariance.diagonal() += noise_variance;
  const auto system = GaussianSystem::make(std::move(covariance), values, false);
  if (!system) return objective;
  objective.value = system->log_marginal_likelihood();
  const MatrixXd inverse = system->inverse();
  const VectorXd a = system->weights();
  objective.gradient(0) = 0.5 * (a.dot(by_log_depth * a) - inverse.cwiseProduct(by_log_depth).sum());
  const VectorXd by_log_noise = (a.cwiseAbs2() - inverse.diagonal()).cwiseProduct(noise_variance);
  const auto n = values.size() / static_cast<Index>(components.size());
  for (std::size_t k = 0; k < components.size(); ++k)
    objective.gradient(components[k] == 2 ? 2 : 1) +=
        by_log_noise.segment(static_cast<Index>(k) * n, n).sum();
  return objective;
}

Objective of_block(const HarmonicHyperparameters& h, const std::vector<Fingerprint>& block) {
  std::vector<Vector2d> points_m;
  for (const Fingerprint& f : block) points_m.push_back(f.position_m);
  const auto n = static_cast<Index>(block.size());
  const MatrixXd covariance = harmonic_covariance(h, points_m, points_m);
  constexpr double kStep = 1e-4;  // of the log; the covariance is smooth in it
  HarmonicHyperparameters deeper = h, shallower = h;
  deeper.depth_m *= std::exp(kStep);
  shallower.depth_m *= std::exp(-kStep);
  const MatrixXd by_log_depth =
      (harmonic_covariance(deeper, points_m, points_m) - harmonic_covariance(shallower, points_m, points_m)) /
      (2 * kStep);
  const VectorXd values = stacked(h, block);
  Objective sum{0.0, VectorXd::Zero(3)};
  for (const std::vector<int>& components : coupled_components(h.side)) {
    const Index first = components.front() * n, rows = static_cast<Index>(components.size()) * n;
    VectorXd noise_variance(rows);
    for (std::size_t k = 0; k < components.size(); ++k)
      noise_variance.segment(static_cast<Index>(k) * n, n).setConstant(h.noise_sd_uT.square()(components[k]));
    const Objective part = log_likelihood(covariance.block(first, first, rows, rows),
                                          by_log_depth.block(first, first, rows, rows), noise_variance,
                                          values.segment(first, rows), components);
    sum.value += part.value;
    sum.gradient += part.gradient;
  }
  return sum;
}

/// Log posterior of the three logs, blocks in parallel, summed in their order.
Objective log_posterior(const HarmonicHyperparameters& start,
                        const std::vector<std::vector<Fingerprint>>& blocks, const VectorXd& logs,
                        Threads threads) {
  const HarmonicHyperparameters h = with(start, logs);
  std::vector<Objective> parts(blocks.size());
  parallel_for(blocks.size(), threads, [&](std::size_t b) { parts[b] = of_block(h, blocks[b]); });
  Objective sum{0.0, VectorXd::Zero(3)};
  for (const Objective& part : parts) {
    sum.value += part.value;
    sum.gradient += part.gradient;
  }
  for (int k = 0; k < 3; ++k) {
    const Prior& prior = kPriors[static_cast<std::size_t>(k)];
    const double z = (logs(k) - std::log(prior.median)) / prior.log_sd;
    sum.value -= 0.5 * z * z;
    sum.gradient(k) -= z / prior.log_sd;
  }
  return sum;
}

}  // namespace

std::optional<HarmonicHyperparameters> learn_harmonic(std::span<const Fingerprint> fingerprints,
                                                      const FieldHyperparameters& independent,
                                                      const LearningOptions& options) {
  HarmonicHyperparameters start;
  start.mean_uT = independent.mean_uT;
  // The variances of B_x and B_y together are that of B_z.
  start.signal_sd_uT = std::sqrt(0.5 * independent.signal_sd_uT.square().sum());
  start.depth_m = independent.length_scale_m.maxCoeff() / as_independent({.depth_m = 1.0}).length_scale_m(0);
  LearningOptions smaller = options;
  smaller.samples_per_block = options.samples_per_block / 3;  // three rows each
  const auto blocks =
      learning_blocks(fingerprints, options.block_side * independent.length_scale_m.maxCoeff(), smaller);
  if (blocks.empty()) return std::nullopt;
  VectorXd low(3), high(3), logs(3);
  for (int k = 0; k < 3; ++k) {
    low(k) = std::log(kPriors[static_cast<std::size_t>(k)].low);
    high(k) = std::log(kPriors[static_cast<std::size_t>(k)].high);
  }
  const Eigen::Array3d ratio = independent.noise_sd_uT / start.signal_sd_uT;
  logs << std::log(start.depth_m), std::log(ratio.head<2>().mean()), std::log(ratio(2));
  logs = logs.cwiseMax(low).cwiseMin(high);
  std::optional<HarmonicHyperparameters> best;
  double best_value = -std::numeric_limits<double>::infinity();
  for (const SourceSide side : {SourceSide::kBoth, SourceSide::kBelow, SourceSide::kAbove}) {
    start.side = side;
    const Maximum found =
        maximise([&](const VectorXd& at) { return log_posterior(start, blocks, at, options.threads); }, logs,
                 low, high);
    if (!(found.value > best_value)) continue;
    best_value = found.value;
    best = with(start, found.at);
    logs = found.at;  // of another side they are hardly different
  }
  return best;
}

}  // namespace mstsl
