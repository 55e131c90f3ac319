#include "mstsl/mapping/field_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// What sensors may have wrong: the older one's level bias, the newer one's, and the difference of the
/// vertical ones. On one drive the first two are one and the last is zero.
constexpr int kBiases = 5;
using Biases = Eigen::Matrix<double, kBiases, 1>;
using ByBiases = Eigen::Matrix<double, 3, kBiases>;

/// A reading and the nearest older one.
struct Pair {
  Vector3d difference_uT;  ///< older less newer, in the older one's axes
  ByBiases by_bias;        ///< how it changes with them
  double same_uT2 = 0.0;   ///< variance of a component if the two lie as near as assumed
  double weight = 0.0;     ///< of one independent piece of evidence
};

std::vector<Pair> pairs_of(std::span<const FieldAt> older, std::span<const FieldAt> newer, const Pose2& a_T_b,
                           const FieldVariogram& variogram, const FieldEvidenceOptions& options) {
  std::vector<Pair> pairs;
  const Eigen::Rotation2Dd a_R_b(a_T_b.yaw);
  for (std::size_t i = 0; i < newer.size(); ++i) {
    const Vector2d at_m = a_T_b * newer[i].position_m;
    const FieldAt* nearest = nullptr;
    double squared_m2 = options.reach_m * options.reach_m;
    for (const FieldAt& old : older) {
      const double d = (old.position_m - at_m).squaredNorm();
      if (d < squared_m2) squared_m2 = d, nearest = &old;
    }
    if (nearest == nullptr) continue;
    const double way_m = i == 0 ? 0.1 : (newer[i].position_m - newer[i - 1].position_m).norm();
    const Vector2d level = a_R_b * newer[i].field_uT.head<2>();
    Pair pair;
    pair.difference_uT = nearest->field_uT - Vector3d(level.x(), level.y(), newer[i].field_uT.z());
    const Eigen::Matrix2d by_older = Eigen::Rotation2Dd(nearest->heading_rad).toRotationMatrix();
    const Eigen::Matrix2d by_newer = Eigen::Rotation2Dd(a_T_b.yaw + newer[i].heading_rad).toRotationMatrix();
    pair.by_bias.setZero();
    pair.by_bias.topLeftCorner<2, 2>() = by_older;
    if (options.one_bias)
      pair.by_bias.topLeftCorner<2, 2>() -= by_newer;
    else
      pair.by_bias.block<2, 2>(0, 2) = -by_newer, pair.by_bias(2, 4) = 1.0;
    const double apart_m = std::sqrt(squared_m2 + options.pose_sd_m * options.pose_sd_m);
    pair.same_uT2 = variogram.squared_difference_uT2(apart_m) + options.noise_uT * options.noise_uT;
    pair.weight = std::min(1.0, way_m / options.correlation_m);
    pairs.push_back(pair);
  }
  return pairs;
}

double log_normal(double squared_uT2, double variance_uT2) {
  return -1.5 * std::log(2 * kPi * variance_uT2) - 0.5 * squared_uT2 / variance_uT2;
}

/// log((1 - share) p + share q), and the part of p in it.
std::pair<double, double> mixed(double log_p, double log_q, double share) {
  const double p = std::log1p(-share) + log_p, q = std::log(share) + log_q, most = std::max(p, q);
  const double sum = std::exp(p - most) + std::exp(q - most);
  return {most + std::log(sum), std::exp(p - most) / sum};
}

/// Log probability of the differences, each `variance(pair)` wide but for outliers, with the best bias (and
/// what it costs to be free to choose it, to second order).
template <typename Variance>
double log_probability(const std::vector<Pair>& pairs, double outlier_uT2,
                       const FieldEvidenceOptions& options, Variance variance) {
  using Curvature = Eigen::Matrix<double, kBiases, kBiases>;
  const double prior = 1.0 / (options.bias_sd_uT * options.bias_sd_uT);
  std::vector<double> inlier(pairs.size(), 1.0);
  Biases bias = Biases::Zero();
  Curvature curvature = prior * Curvature::Identity();
  double log_p = 0.0;
  for (int round = 0; round < 4; ++round) {
    Biases slope = Biases::Zero();
    curvature = prior * Curvature::Identity();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double w = pairs[i].weight * inlier[i] / variance(pairs[i]);
      slope += w * pairs[i].by_bias.transpose() * pairs[i].difference_uT;
      curvature += w * pairs[i].by_bias.transpose() * pairs[i].by_bias;
    }
    bias = curvature.ldlt().solve(slope);
    log_p = 0.0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double left = (pairs[i].difference_uT - pairs[i].by_bias * bias).squaredNorm();
      const auto [log_both, share] =
          mixed(log_normal(left, variance(pairs[i])), log_normal(left, outlier_uT2), options.outlier_share);
      inlier[i] = share;
      log_p += pairs[i].weight * log_both;
    }
  }
  // What it costs to be free to choose them: the room that the readings leave, of what there was.
  const double room = (curvature / prior).ldlt().vectorD().array().log().sum();
  return log_p - 0.5 * prior * bias.squaredNorm() - 0.5 * room;
}

}  // namespace

void FieldVariogram::add(std::span<const FieldAt> stretch) {
  for (std::size_t i = 0; i < stretch.size(); ++i)
    for (std::size_t k = i; k-- > 0;) {
      // Only where the robot kept its heading: a turn would show the sensor's bias as a difference.
      constexpr double kSameHeading_rad = 0.2;
      if (std::abs(angle_between(stretch[k].heading_rad, stretch[i].heading_rad)) > kSameHeading_rad) break;
      const double d = (stretch[i].position_m - stretch[k].position_m).norm();
      const auto bin = static_cast<std::size_t>(d / kBin_m);
      if (bin >= kBins) break;
      bins_[bin].sum_uT2 += (stretch[i].field_uT - stretch[k].field_uT).squaredNorm() / 3.0;
      bins_[bin].pairs += 1.0;
    }
}

bool FieldVariogram::is_known() const {
  constexpr double kEnough = 300;  // some ten independent stretches
  return bins_[kBins / 2].pairs >= kEnough;
}

double FieldVariogram::squared_difference_uT2(double distance_m) const {
  // Between the middles of the bins, and to 0 at 0: a field is smooth.
  const double at = distance_m / kBin_m - 0.5;
  const auto mean = [&](std::size_t bin) {
    return bins_[bin].pairs > 0 ? bins_[bin].sum_uT2 / bins_[bin].pairs : unrelated_uT2();
  };
  if (at <= 0.0) return mean(0) * std::pow(distance_m / (0.5 * kBin_m), 2);
  const auto low = static_cast<std::size_t>(at);
  if (low + 1 >= kBins) return unrelated_uT2();
  return mean(low) + (at - static_cast<double>(low)) * (mean(low + 1) - mean(low));
}

double FieldVariogram::unrelated_uT2() const {
  double sum = 0.0, pairs = 0.0;
  for (std::size_t bin = kBins / 2; bin < kBins; ++bin) sum += bins_[bin].sum_uT2, pairs += bins_[bin].pairs;
  return pairs > 0 ? sum / pairs : 0.0;
}

FieldEvidence field_evidence(std::span<const FieldAt> older_a, std::span<const FieldAt> newer_b,
                             const Pose2& a_T_b, const FieldVariogram& variogram,
                             const FieldEvidenceOptions& options) {
  FieldEvidence evidence;
  if (!variogram.is_known()) return evidence;
  const std::vector<Pair> pairs = pairs_of(older_a, newer_b, a_T_b, variogram, options);
  if (pairs.empty()) return evidence;
  for (const Pair& pair : pairs) evidence.compared_m += pair.weight * options.correlation_m;
  const double unrelated = variogram.unrelated_uT2() + options.noise_uT * options.noise_uT;
  const auto same = [&](const Pair& pair) { return std::min(pair.same_uT2, unrelated); };
  evidence.log_ratio =
      log_probability(pairs, 2.0 * unrelated, options, same) -
      log_probability(pairs, 2.0 * unrelated, options, [&](const Pair&) { return unrelated; });
  return evidence;
}

}  // namespace mstsl
