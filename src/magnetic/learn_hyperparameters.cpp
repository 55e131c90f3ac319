#include "mstsl/magnetic/learn_hyperparameters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "mstsl/magnetic/gaussian_process.hpp"
#include "mstsl/magnetic/tile_regression.hpp"

#include "learning_blocks.hpp"
#include "maximise.hpp"

namespace mstsl {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr std::size_t kFewestFingerprints = 20;

/// Log-normal prior of one parameter, and the range in which it is looked for.
struct Prior {
  double median, log_sd, low, high;
};
// The field's correlation falls to one half at 0.4-3 m in real buildings; a squared exponential's does so
// at 1.18 l. A shorter one than 0.2 m is no field but outliers, and a map of it knows nothing between lanes.
constexpr Prior kLengthScale_m{0.8, 0.8, 0.2, 6.0};
// Sensor noise 0.05-0.5 uT and position errors of 1 cm, on a field of 5-13 uT.
constexpr Prior kNoiseRatio{0.1, 1.2, TileRegression::kMinNoiseRatio, 2.0};

struct Block {
  std::vector<Vector2d> points_m;
  MatrixXd values;  ///< standardised, points x 3
};

std::vector<Block> standardised_blocks(std::span<const Fingerprint> fingerprints, const Moments& moments,
                                       double side_m, const LearningOptions& options) {
  std::vector<Block> blocks;
  for (const std::vector<Fingerprint>& chosen : learning_blocks(fingerprints, side_m, options)) {
    Block& block = blocks.emplace_back();
    block.values.resize(static_cast<Eigen::Index>(chosen.size()), 3);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      block.points_m.push_back(chosen[k].position_m);
      block.values.row(static_cast<Eigen::Index>(k)) =
          ((chosen[k].field_uT.array() - moments.mean) / moments.sd).transpose();
    }
  }
  return blocks;
}

using Kernel = Sum<SquaredExponential, WhiteNoise>;

Kernel kernel_of(const VectorXd& logs) {
  return SquaredExponential{1.0, std::exp(logs(0))} + WhiteNoise{std::exp(logs(1))};
}

void add_prior(const Prior& prior, int parameter, const VectorXd& logs, Objective& objective) {
  const double z = (logs(parameter) - std::log(prior.median)) / prior.log_sd;
  objective.value -= 0.5 * z * z;
  objective.gradient(parameter) -= z / prior.log_sd;
}

/// Log posterior of (log length scale, log noise ratio), blocks in parallel, summed in their order.
Objective log_posterior(const std::vector<Block>& blocks, const VectorXd& logs, Threads threads) {
  std::vector<Objective> parts(blocks.size());
  parallel_for(blocks.size(), threads, [&](std::size_t b) {
    const auto part = log_marginal_likelihood(kernel_of(logs), blocks[b].points_m, blocks[b].values, true);
    parts[b].value = part ? part->value : std::numeric_limits<double>::quiet_NaN();
    parts[b].gradient =
        part ? VectorXd{{part->by_log_parameter[1], part->by_log_parameter[2]}} : VectorXd::Zero(2);
  });
  Objective sum{0.0, VectorXd::Zero(2)};
  for (const Objective& part : parts) {
    sum.value += part.value;
    sum.gradient += part.gradient;
  }
  add_prior(kLengthScale_m, 0, logs, sum);
  add_prior(kNoiseRatio, 1, logs, sum);
  return sum;
}

/// The best of a short and a long start: along lanes the likelihood may have two maxima.
Maximum search(const std::vector<Block>& blocks, Threads threads) {
  const VectorXd low{{std::log(kLengthScale_m.low), std::log(kNoiseRatio.low)}};
  const VectorXd high{{std::log(kLengthScale_m.high), std::log(kNoiseRatio.high)}};
  const auto objective = [&](const VectorXd& logs) { return log_posterior(blocks, logs, threads); };
  Maximum best{VectorXd{{std::log(kLengthScale_m.median), std::log(kNoiseRatio.median)}},
               -std::numeric_limits<double>::infinity()};
  for (const double length_scale_m : {0.4, 1.2}) {
    const Maximum found = maximise(objective, VectorXd{{std::log(length_scale_m), std::log(0.1)}}, low, high);
    if (found.value > best.value) best = found;
  }
  return best;
}

/// Steps of a factor sqrt(2) by which a block alone would have more noise than all together.
int surplus_noise(const Block& block, const VectorXd& logs) {
  const double kStep = 0.5 * std::log(2.0);
  const auto value = [&](int steps) {
    const VectorXd other{{logs(0), logs(1) + steps * kStep}};
    const auto likelihood = log_marginal_likelihood(kernel_of(other), block.points_m, block.values, true);
    return likelihood ? likelihood->value : -std::numeric_limits<double>::infinity();
  };
  constexpr int kMostSteps = 12;
  int best = 0;
  double best_value = value(0);
  for (const int direction : {-1, 1})
    for (int steps = direction; std::abs(steps) <= kMostSteps; steps += direction) {
      const double here = value(steps);
      if (!(here > best_value)) break;
      best = steps;
      best_value = here;
    }
  return best;
}

/// Leaves out blocks with more than twice the noise of most, whatever their length scale: something moved
/// there while the survey was made, and nothing must be learned from it for all. (A rougher field than
/// elsewhere is none of that: with a shorter length scale of its own such a block has no more noise than
/// others.)
std::vector<Block> quiet_blocks(const std::vector<Block>& blocks, const VectorXd& logs, Threads threads) {
  constexpr int kTwice = 2;
  std::vector<int> steps(blocks.size());
  parallel_for(blocks.size(), threads, [&](std::size_t b) { steps[b] = surplus_noise(blocks[b], logs); });
  std::vector<int> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  std::vector<Block> quiet;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const double allowed = logs(1) + 0.5 * std::log(2.0) * (*middle + kTwice);
    if (steps[b] <= *middle + kTwice || search({blocks[b]}, threads).at(1) <= allowed)
      quiet.push_back(blocks[b]);
  }
  return quiet;
}

/// Generalised least squares over all blocks: fingerprints that say the same count once.
Eigen::Array3d learn_mean(const std::vector<Block>& blocks, const Kernel& kernel, const Moments& moments) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  double weight = 0.0;
  for (const Block& block : blocks) {
    const auto n = static_cast<Eigen::Index>(block.points_m.size());
    MatrixXd with_ones(n, 4);
    with_ones << block.values, VectorXd::Ones(n);
    const auto system = GaussianSystem::make(covariance_matrix(kernel, block.points_m), with_ones, false);
    if (!system) continue;
    sum += system->weights().leftCols<3>().colwise().sum().transpose().array();
    weight += system->weights().col(3).sum();
  }
  return weight > 0.0 ? Eigen::Array3d(moments.mean + moments.sd * sum / weight) : moments.mean;
}

std::vector<std::string> doubts(const LearnedHyperparameters& learned, const Moments& moments) {
  std::vector<std::string> warnings;
  const double l = learned.values.length_scale_m(0);
  if (l < 1.05 * kLengthScale_m.low || l > 0.95 * kLengthScale_m.high)
    warnings.push_back(fmt::format(
        "the length scale came out at {:.2f} m, the end of what is looked for; the survey cannot tell it",
        l));
  if (learned.samples < 100)
    warnings.push_back(fmt::format(
        "only {} fingerprints to learn from: length scale and noise rest on what other buildings show",
        learned.samples));
  if (moments.sd.maxCoeff() < 0.2)
    warnings.push_back(fmt::format(
        "the field varies by {:.2f} uT only: nothing here tells places apart, or its unit is wrong",
        moments.sd.maxCoeff()));
  return warnings;
}

}  // namespace

Result<LearnedHyperparameters> learn_hyperparameters(std::span<const Fingerprint> fingerprints,
                                                     const LearningOptions& options) {
  if (fingerprints.size() < kFewestFingerprints)
    return Error(fmt::format(
        "{} fingerprints are too few to learn a field from, {} is the least; drive a longer survey",
        fingerprints.size(), kFewestFingerprints));
  std::vector<Vector2d> points;
  for (const Fingerprint& f : fingerprints) {
    if (!f.position_m.allFinite() || !f.field_uT.allFinite())
      return Error("a fingerprint holds a value that is not finite");
    points.push_back(f.position_m);
  }
  const Moments moments = moments_over_area(fingerprints, points);
  double side_m = options.block_side * kLengthScale_m.median;
  std::vector<Block> blocks;
  Maximum best;
  constexpr int kRounds = 3;  // the length scale decides the blocks that it is learned from
  for (int round = 0; round < kRounds; ++round) {
    blocks = standardised_blocks(fingerprints, moments, side_m, options);
    best = search(blocks, options.threads);
    const double wanted_m = options.block_side * std::exp(best.at(0));
    if (wanted_m <= 1.1 * side_m) break;
    side_m = 1.1 * wanted_m;
  }
  if (auto quiet = quiet_blocks(blocks, best.at, options.threads); quiet.size() < blocks.size()) {
    blocks = std::move(quiet);
    best = search(blocks, options.threads);
  }
  LearnedHyperparameters learned;
  const Kernel kernel = kernel_of(best.at);
  learned.values.signal_sd_uT = moments.sd;
  learned.values.length_scale_m = Eigen::Array3d::Constant(std::exp(best.at(0)));
  learned.values.noise_sd_uT = moments.sd * std::exp(best.at(1));
  learned.values.mean_uT = learn_mean(blocks, kernel, moments);
  learned.blocks = blocks.size();
  for (const Block& block : blocks) learned.samples += block.points_m.size();
  learned.log_likelihood_per_sample =
      best.value / static_cast<double>(std::max<std::size_t>(learned.samples, 1));
  learned.warnings = doubts(learned, moments);
  return learned;
}

}  // namespace mstsl
