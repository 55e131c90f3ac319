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

/// Unknowns a session: bias x y z; stretch and shear of the horizontal field, its leaks into the vertical.
constexpr Index kUnknowns = 7, kSoftUnknowns = 4;
using Sensitivity = Eigen::Matrix<double, 3, kUnknowns>;

/// How the corrected field of a fingerprint, map frame, follows its session's unknowns where the field is
/// `typical_uT`. Its own reading would be more exact, and let an outlier speak for itself.
Sensitivity sensitivity(const Fingerprint& f, const Vector3d& typical_uT) {
  const Matrix3d rotation = f.map_R_base();
  const Vector3d m = rotation.transpose() * typical_uT;
  Sensitivity base = Sensitivity::Zero();
  base.leftCols<3>() = -Matrix3d::Identity();
  base.block<2, 2>(0, 3) << m.x(), m.y(), -m.y(), m.x();
  base.block<1, 2>(2, 5) = m.head<2>().transpose();
  return rotation * base;
}

Matrix3d soft_iron_from(const Eigen::Vector4d& unknowns) {
  Matrix3d soft = Matrix3d::Identity();
  soft.topLeftCorner<2, 2>() << 1 + unknowns(0), unknowns(1), unknowns(1), 1 - unknowns(0);
  soft.bottomLeftCorner<1, 2>() = unknowns.tail<2>().transpose();
  return soft;
}

struct Observation {
  const Fingerprint* a;
  const Fingerprint* b;
  Sensitivity of_a = Sensitivity::Zero(), of_b = Sensitivity::Zero();
  std::size_t cluster = 0;

  /// What the errors of all sessions, one after the other, leave of the difference.
  Vector3d residual(const VectorXd& errors) const {
    return a->field_uT - b->field_uT + of_a * errors.segment<kUnknowns>(kUnknowns * a->session) -
           of_b * errors.segment<kUnknowns>(kUnknowns * b->session);
  }
};

/// The median of each component.
Vector3d typical_field_uT(std::span<const Fingerprint> fingerprints) {
  Vector3d typical = Vector3d::Zero();
  std::vector<double> values(fingerprints.size());
  for (int c = 0; c < 3 && !values.empty(); ++c) {
    std::transform(fingerprints.begin(), fingerprints.end(), values.begin(),
                   [c](const Fingerprint& f) { return f.field_uT(c); });
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    typical(c) = *middle;
  }
  return typical;
}

/// Each fingerprint with its nearest neighbour of another heading or session; each pair once.
std::vector<Observation> find_pairs(std::span<const Fingerprint> fingerprints,
                                    const SurveyBiasOptions& options) {
  std::vector<Eigen::Vector2d> points;
  for (const Fingerprint& f : fingerprints) points.push_back(f.position_m);
  const PointBins bins(points, options.pair_distance_m);
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(options.pair_distance_m);
  const Vector3d typical_uT = typical_field_uT(fingerprints);
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
      pairs.push_back({&fingerprints[i], &fingerprints[j], sensitivity(fingerprints[i], typical_uT),
                       sensitivity(fingerprints[j], typical_uT)});
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
std::vector<double> huber_weights(const std::vector<Observation>& pairs, const VectorXd& errors) {
  std::vector<double> lengths;
  for (const Observation& pair : pairs) lengths.push_back(pair.residual(errors).norm());
  std::vector<double> sorted = lengths;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double limit =
      std::max(*middle, 1e-9);  // most residuals are full evidence only up to the median length
  for (double& length : lengths) length = length <= limit ? 1.0 : limit / length;
  return lengths;
}

struct Solution {
  VectorXd errors;
  MatrixXd covariance;
};

/// The normal equations of the weighted least squares, and each cluster's part of the gradient.
struct Normal {
  Normal(std::size_t clusters, const VectorXd& prior, const VectorXd& errors)
      : matrix(prior.asDiagonal()),
        gradient(-prior.cwiseProduct(errors)),
        scores(MatrixXd::Zero(prior.size(), static_cast<Index>(clusters))) {}

  void add(const Observation& pair, double weight, const Vector3d& residual) {
    const Index a = kUnknowns * pair.a->session, b = kUnknowns * pair.b->session;
    const Sensitivity &ja = pair.of_a, jb = -pair.of_b;
    const auto block = [this](Index row, Index column) {
      return matrix.block<kUnknowns, kUnknowns>(row, column);
    };
    block(a, a) += weight * ja.transpose() * ja;
    block(b, b) += weight * jb.transpose() * jb;
    block(a, b) += weight * ja.transpose() * jb;
    block(b, a) += weight * jb.transpose() * ja;
    for (const auto& [row, j] : {std::pair{a, ja}, std::pair{b, jb}}) {
      const Eigen::Vector<double, kUnknowns> part = -weight * j.transpose() * residual;
      gradient.segment<kUnknowns>(row) += part;
      scores.col(static_cast<Index>(pair.cluster)).segment<kUnknowns>(row) += part;
    }
  }

  MatrixXd matrix;
  VectorXd gradient;
  MatrixXd scores;
};

/// Iteratively reweighted least squares with a weak prior at 0; the covariance is the cluster-robust
/// sandwich.
Solution solve(const std::vector<Observation>& pairs, std::size_t clusters, int sessions, double bias_sd_uT,
               double soft_iron_sd) {
  constexpr int kIterations = 20;
  VectorXd prior_sd(kUnknowns * sessions);
  for (Index i = 0; i < prior_sd.size(); ++i) prior_sd(i) = i % kUnknowns < 3 ? bias_sd_uT : soft_iron_sd;
  Solution solution{VectorXd::Zero(prior_sd.size()), MatrixXd(prior_sd.cwiseAbs2().asDiagonal())};
  for (int iteration = 0; iteration < kIterations && !pairs.empty(); ++iteration) {
    const std::vector<double> weights = huber_weights(pairs, solution.errors);
    double variance = 1e-12;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      variance += weights[i] * pairs[i].residual(solution.errors).squaredNorm() /
                  (3.0 * static_cast<double>(pairs.size()));
    const VectorXd prior = variance * prior_sd.cwiseAbs2().cwiseInverse();
    Normal normal(clusters, prior, solution.errors);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      normal.add(pairs[i], weights[i], pairs[i].residual(solution.errors));
    const Eigen::LDLT<MatrixXd> factor(normal.matrix);
    solution.errors += factor.solve(normal.gradient);
    const MatrixXd inverse = factor.solve(MatrixXd::Identity(prior.size(), prior.size()));
    const MatrixXd spread =
        normal.scores * normal.scores.transpose() + MatrixXd((variance * prior).asDiagonal());
    solution.covariance = inverse * spread * inverse;
  }
  return solution;
}

bool is_soft_iron_significant(const Solution& solution, Index first, const SurveyBiasOptions& options) {
  const Eigen::Vector4d soft = solution.errors.segment<kSoftUnknowns>(first + 3);
  const Eigen::Vector4d sd = solution.covariance.diagonal().segment<kSoftUnknowns>(first + 3).cwiseSqrt();
  return ((soft.array().abs() >= options.significant_sigmas * sd.array()) &&
          (soft.array().abs() >= options.least_soft_iron))
      .any();
}

SessionBias session_from(const Solution& solution, Index first, bool tells, bool has_soft_iron,
                         const SurveyBiasOptions& options) {
  SessionBias session;
  session.base_bias_uT = solution.errors.segment<3>(first);
  session.sd_uT = solution.covariance.diagonal().segment<3>(first).cwiseSqrt();
  const double sigmas = (session.base_bias_uT.array().abs() / session.sd_uT.array()).maxCoeff();
  session.has_soft_iron = has_soft_iron;
  if (has_soft_iron) session.soft_iron = soft_iron_from(solution.errors.segment<kSoftUnknowns>(first + 3));
  session.soft_iron_sd =
      std::sqrt(solution.covariance.diagonal().segment<kSoftUnknowns>(first + 3).maxCoeff());
  session.significant = tells && (sigmas >= options.significant_sigmas || has_soft_iron);
  return session;
}

}  // namespace

bool SurveyBias::any_significant() const {
  return std::any_of(sessions.begin(), sessions.end(), [](const SessionBias& s) { return s.significant; });
}

SurveyBias estimate_survey_bias(std::span<const Fingerprint> fingerprints, const SurveyBiasOptions& options) {
  // The spread over a handful of clusters says nothing about itself.
  constexpr std::size_t kFewestClusters = 8;
  constexpr double kNone = 1e-9;  // a prior that leaves no soft iron
  int sessions = 0;
  for (const Fingerprint& f : fingerprints) sessions = std::max(sessions, f.session + 1);
  std::vector<Observation> pairs = find_pairs(fingerprints, options);
  const std::size_t clusters = assign_clusters(pairs);
  const bool tells = clusters >= kFewestClusters;
  const Solution bias_only = solve(pairs, clusters, sessions, options.prior_sd_uT, kNone);
  const Solution whole =
      tells ? solve(pairs, clusters, sessions, options.prior_sd_uT, options.soft_iron_sd) : bias_only;
  SurveyBias result{{}, pairs.size()};
  for (Index first = 0; first < kUnknowns * sessions; first += kUnknowns) {
    const bool soft_iron = tells && is_soft_iron_significant(whole, first, options);
    result.sessions.push_back(session_from(soft_iron ? whole : bias_only, first, tells, soft_iron, options));
  }
  return result;
}

void remove_bias(std::span<Fingerprint> fingerprints, const SurveyBias& bias) {
  for (Fingerprint& f : fingerprints) {
    const SessionBias& session = bias.sessions[static_cast<std::size_t>(f.session)];
    const Matrix3d rotation = f.map_R_base();
    f.field_uT = rotation * (session.soft_iron * (rotation.transpose() * f.field_uT) - session.base_bias_uT);
  }
}

}  // namespace mstsl
