#include "mstsl/magnetic/survey_bias.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "mstsl/core/angles.hpp"

#include "point_bins.hpp"

namespace mstsl {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kCluster_m =
    2.0;  // longer than the field's correlation along a corridor (1.5-3 m to one half)

Matrix3d map_R_base(const Fingerprint& f) {
  return Eigen::AngleAxisd(f.heading_rad, Vector3d::UnitZ()).toRotationMatrix();
}

struct Observation {
  const Fingerprint* a;
  const Fingerprint* b;
  std::size_t cluster = 0;

  Vector3d difference() const { return a->field_uT - b->field_uT; }
  /// What the biases of all sessions, one after the other, leave of the difference.
  Vector3d residual(const VectorXd& biases) const {
    return difference() - map_R_base(*a) * biases.segment<3>(3 * a->session) +
           map_R_base(*b) * biases.segment<3>(3 * b->session);
  }
};

/// Each fingerprint with its nearest neighbour of another heading or session; each pair once.
std::vector<Observation> find_pairs(std::span<const Fingerprint> fingerprints,
                                    const SurveyBiasOptions& options) {
  std::vector<Eigen::Vector2d> points;
  for (const Fingerprint& f : fingerprints) points.push_back(f.position_m);
  const PointBins bins(points, options.pair_distance_m);
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(options.pair_distance_m);
  std::vector<Observation> pairs;
  std::vector<std::size_t> partner(points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    double nearest_m = options.pair_distance_m;
    bins.for_each_near(points[i] - reach, points[i] + reach, [&](std::size_t j) {
      const double distance_m = (points[j] - points[i]).norm();
      const bool turned = std::abs(angle_between(fingerprints[i].heading_rad, fingerprints[j].heading_rad)) >=
                          options.pair_turn_rad;
      if (j == i || distance_m >= nearest_m ||
          !(turned || fingerprints[i].session != fingerprints[j].session))
        return;
      nearest_m = distance_m;
      partner[i] = j;
    });
    const std::size_t j = partner[i];
    if (j < points.size() && (j > i || partner[j] != i))
      pairs.push_back({&fingerprints[i], &fingerprints[j]});
  }
  return pairs;
}

/// Numbers the clusters of pairs that lie in the same square.
std::size_t assign_clusters(std::vector<Observation>& pairs) {
  std::map<std::pair<long, long>, std::size_t> numbers;
  for (Observation& pair : pairs) {
    const Eigen::Vector2d cell = pair.a->position_m / kCluster_m;
    pair.cluster =
        numbers.try_emplace({std::lround(cell.x()), std::lround(cell.y())}, numbers.size()).first->second;
  }
  return numbers.size();
}

/// Huber's weights for residual lengths, with the scale of their median.
std::vector<double> huber_weights(const std::vector<Observation>& pairs, const VectorXd& biases) {
  std::vector<double> lengths;
  for (const Observation& pair : pairs) lengths.push_back(pair.residual(biases).norm());
  std::vector<double> sorted = lengths;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double limit =
      std::max(*middle, 1e-9);  // most residuals are full evidence only up to the median length
  for (double& length : lengths) length = length <= limit ? 1.0 : limit / length;
  return lengths;
}

struct Solution {
  VectorXd biases;
  MatrixXd covariance;
};

/// The normal equations of the weighted least squares, and each cluster's part of the gradient.
struct Normal {
  Normal(Index size, std::size_t clusters, double prior, const VectorXd& biases)
      : matrix(MatrixXd::Identity(size, size) * prior),
        gradient(-prior * biases),
        scores(MatrixXd::Zero(size, static_cast<Index>(clusters))) {}

  void add(const Observation& pair, double weight, const Vector3d& residual) {
    const Index a = 3 * pair.a->session, b = 3 * pair.b->session;
    const Matrix3d ra = map_R_base(*pair.a), rb = map_R_base(*pair.b);
    matrix.block<3, 3>(a, a) += weight * Matrix3d::Identity();
    matrix.block<3, 3>(b, b) += weight * Matrix3d::Identity();
    matrix.block<3, 3>(a, b) -= weight * ra.transpose() * rb;
    matrix.block<3, 3>(b, a) -= weight * rb.transpose() * ra;
    for (const auto& [row, part] : {std::pair{a, Vector3d(weight * ra.transpose() * residual)},
                                    std::pair{b, Vector3d(-weight * rb.transpose() * residual)}}) {
      gradient.segment<3>(row) += part;
      scores.col(static_cast<Index>(pair.cluster)).segment<3>(row) += part;
    }
  }

  MatrixXd matrix;
  VectorXd gradient;
  MatrixXd scores;
};

/// Iteratively reweighted least squares with a weak prior at 0; the covariance is the cluster-robust
/// sandwich.
Solution solve(const std::vector<Observation>& pairs, std::size_t clusters, Index size, double prior_sd_uT) {
  constexpr int kIterations = 20;
  Solution solution{VectorXd::Zero(size), MatrixXd::Identity(size, size) * prior_sd_uT * prior_sd_uT};
  for (int iteration = 0; iteration < kIterations && !pairs.empty(); ++iteration) {
    const std::vector<double> weights = huber_weights(pairs, solution.biases);
    double variance = 1e-12;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      variance += weights[i] * pairs[i].residual(solution.biases).squaredNorm() /
                  (3.0 * static_cast<double>(pairs.size()));
    const double prior = variance / (prior_sd_uT * prior_sd_uT);
    Normal normal(size, clusters, prior, solution.biases);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      normal.add(pairs[i], weights[i], pairs[i].residual(solution.biases));
    const Eigen::LDLT<MatrixXd> factor(normal.matrix);
    solution.biases += factor.solve(normal.gradient);
    const MatrixXd inverse = factor.solve(MatrixXd::Identity(size, size));
    const MatrixXd spread =
        normal.scores * normal.scores.transpose() + MatrixXd::Identity(size, size) * prior * variance;
    solution.covariance = inverse * spread * inverse;
  }
  return solution;
}

}  // namespace

bool SurveyBias::any_significant() const {
  return std::any_of(sessions.begin(), sessions.end(), [](const SessionBias& s) { return s.significant; });
}

SurveyBias estimate_survey_bias(std::span<const Fingerprint> fingerprints, const SurveyBiasOptions& options) {
  int sessions = 0;
  for (const Fingerprint& f : fingerprints) sessions = std::max(sessions, f.session + 1);
  std::vector<Observation> pairs = find_pairs(fingerprints, options);
  const std::size_t clusters = assign_clusters(pairs);
  const Solution solution = solve(pairs, clusters, 3 * sessions, options.prior_sd_uT);
  SurveyBias result{std::vector<SessionBias>(static_cast<std::size_t>(sessions)), pairs.size()};
  // The spread over a handful of clusters says nothing about itself.
  constexpr std::size_t kFewestClusters = 8;
  for (int s = 0; s < sessions; ++s) {
    SessionBias& session = result.sessions[static_cast<std::size_t>(s)];
    session.base_bias_uT = solution.biases.segment<3>(3 * s);
    session.sd_uT = solution.covariance.diagonal().segment<3>(3 * s).cwiseSqrt();
    const double sigmas = (session.base_bias_uT.array().abs() / session.sd_uT.array()).maxCoeff();
    session.significant = clusters >= kFewestClusters && sigmas >= options.significant_sigmas;
  }
  return result;
}

void remove_bias(std::span<Fingerprint> fingerprints, const SurveyBias& bias) {
  for (Fingerprint& f : fingerprints)
    f.field_uT -= map_R_base(f) * bias.sessions[static_cast<std::size_t>(f.session)].base_bias_uT;
}

}  // namespace mstsl
