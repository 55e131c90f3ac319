#include "mstsl/localize/lidar_stage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Eigenvalues>

#include "mstsl/grid/ray.hpp"

namespace mstsl {
namespace {

/// The covariance with the standard deviations of its position kept within bounds, along its own axes.
Eigen::Matrix3d with_bounded_position(Eigen::Matrix3d covariance, double min_sigma_m, double max_sigma_m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance.topLeftCorner<2, 2>());
  const Eigen::Vector2d sigma_m =
      eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().cwiseMax(min_sigma_m).cwiseMin(max_sigma_m);
  covariance.topLeftCorner<2, 2>() =
      eigen.eigenvectors() * sigma_m.cwiseAbs2().asDiagonal() * eigen.eigenvectors().transpose();
  // Without the correlation of place and heading it stays positive definite whatever the bounds did.
  covariance.topRightCorner<2, 1>().setZero();
  covariance.bottomLeftCorner<1, 2>().setZero();
  return covariance;
}

LidarHypothesis started(const InitialHypothesis& initial, const Pose2& reading_T_base,
                        const LidarStageOptions& options) {
  LidarHypothesis hypothesis;
  hypothesis.map_T_start = initial.map_T_base * reading_T_base;
  hypothesis.start_covariance = moved_covariance(
      initial.map_T_base, with_bounded_position(initial.covariance, options.min_sigma_m, options.max_sigma_m),
      reading_T_base, options.odometry);
  hypothesis.field_probability = initial.probability;
  hypothesis.map_T_base = hypothesis.map_T_start;
  hypothesis.covariance = hypothesis.start_covariance;
  return hypothesis;
}

}  // namespace

std::string_view to_string(Rejection rejection) {
  switch (rejection) {
    case Rejection::kOutOfMap:
      return "out_of_map";
    case Rejection::kCrossesWall:
      return "crosses_wall";
    case Rejection::kLowScore:
      return "low_score";
  }
  return "";
}

LidarStage::LidarStage(std::shared_ptr<const LocalizationMaps> maps,
                       const std::vector<InitialHypothesis>& hypotheses, const Pose2& reading_T_base,
                       const LidarStageOptions& options)
    : maps_(std::move(maps)), options_(options), local_map_(options.local_map) {
  for (const InitialHypothesis& hypothesis : hypotheses)
    hypotheses_.push_back(started(hypothesis, reading_T_base, options));
}

void LidarStage::observe(const std::vector<BeamReturn>& returns_base, const Pose2& last_T_base) {
  unseen_motion_ = unseen_motion_ * last_T_base;
  if (returns_base.empty()) return;  // the next scan that sees something makes up for it
  const bool first = local_map_.empty();
  const Pose2 local_T_last = local_map_.local_T_base();
  local_map_.insert(returns_base, unseen_motion_);
  move_hypotheses(first ? unseen_motion_ : between(local_T_last, local_map_.local_T_base()), first);
  unseen_motion_ = Pose2{};
  const bool due = since_match_m_ >= options_.match_every_m || since_match_rad_ >= options_.match_every_rad;
  if (!first && !due) return;
  since_match_m_ = since_match_rad_ = 0.0;
  match_all(end_points(returns_base));
}

void LidarStage::move_hypotheses(const Pose2& moved, bool local_map_begins) {
  driven_m_ += std::hypot(moved.x, moved.y);
  since_match_m_ += std::hypot(moved.x, moved.y);
  since_match_rad_ += std::abs(moved.yaw);
  for (LidarHypothesis& hypothesis : hypotheses_) {
    if (hypothesis.rejected) continue;
    hypothesis.covariance =
        moved_covariance(hypothesis.map_T_base, hypothesis.covariance, moved, options_.odometry);
    hypothesis.map_T_base = hypothesis.map_T_base * moved;
    if (!local_map_begins) continue;
    hypothesis.map_T_start = hypothesis.map_T_base;
    hypothesis.start_covariance = hypothesis.covariance;
  }
}

void LidarStage::match_all(const PointSet& scan_points_base_m) {
  ++matches_;
  local_path_.push_back(local_map_.local_T_base());
  const PointSet local_points_base_m = local_map_.points_in_base();
  for (LidarHypothesis& hypothesis : hypotheses_) {
    if (hypothesis.rejected) continue;
    match(hypothesis, local_points_base_m, scan_points_base_m);
    if (!hypothesis.rejected) hypothesis.rejected = impossible(hypothesis);
    if (hypothesis.rejected) hypothesis.rejected_after_m = driven_m_;
  }
}

/// The whole local map is matched anew around where the field and the drive since put it: what a short local
/// map could not tell apart, a longer one may.
void LidarStage::match(LidarHypothesis& hypothesis, const PointSet& local_points_base_m,
                       const PointSet& scan_points_base_m) {
  const Pose2& local_T_base = local_map_.local_T_base();
  const PosePrior prior{
      hypothesis.map_T_start * local_T_base,
      moved_covariance(hypothesis.map_T_start, hypothesis.start_covariance, local_T_base, options_.odometry)};
  const auto found =
      match_submap(*maps_->walls, local_points_base_m, scan_points_base_m, prior, options_.match);
  hypothesis.score = found ? found->confidence : 0.0;
  hypothesis.low_scores = hypothesis.score < options_.min_score ? hypothesis.low_scores + 1 : 0;
  if (!found) {
    hypothesis.rejected = Rejection::kLowScore;
    return;
  }
  hypothesis.map_T_base = found->refined.map_T_base;
  hypothesis.covariance = found->refined.covariance;
  const double independent_points =
      static_cast<double>(local_points_base_m.size()) / options_.match.refine.points_per_error;
  hypothesis.scan_log_likelihood = -options_.likelihood_temper * independent_points * found->refined.cost;
}

/// The way driven so far is laid into the map as this hypothesis has it: no part of it may leave the known
/// space or cross a wall.
std::optional<Rejection> LidarStage::impossible(const LidarHypothesis& hypothesis) const {
  if (hypothesis.low_scores >= options_.low_scores_to_reject) return Rejection::kLowScore;
  const Pose2 map_T_local = hypothesis.map_T_base * inverse(local_map_.local_T_base());
  Pose2 from = map_T_local * local_path_.front();
  for (const Pose2& local_T_base : local_path_) {
    const Pose2 to = map_T_local * local_T_base;
    const Crossing crossing = crosses(maps_->occupancy, from.position(), to.position());
    if (crossing.wall) return Rejection::kCrossesWall;
    if (crossing.leaves_known_space()) return Rejection::kOutOfMap;
    from = to;
  }
  return std::nullopt;
}

bool LidarStage::all_rejected() const {
  return std::all_of(hypotheses_.begin(), hypotheses_.end(),
                     [](const LidarHypothesis& hypothesis) { return hypothesis.rejected.has_value(); });
}

std::vector<double> LidarStage::weights() const {
  std::vector<double> weights(hypotheses_.size(), 0.0);
  double best_log = -std::numeric_limits<double>::infinity(), listed = 0.0;
  for (const LidarHypothesis& hypothesis : hypotheses_) {
    listed += hypothesis.field_probability;
    if (!hypothesis.rejected) best_log = std::max(best_log, hypothesis.scan_log_likelihood);
  }
  double sum = 0.0, pass = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (hypotheses_[i].rejected) continue;
    const double likelihood = std::exp(hypotheses_[i].scan_log_likelihood - best_log);
    weights[i] = hypotheses_[i].field_probability * likelihood;
    sum += weights[i];
    pass += likelihood;
  }
  // If the robot is at none of these, the best one got through as a look-alike. How often that happens here
  // is told by the others, which cannot all be right: Laplace's rule of succession over them.
  const double look_alikes = std::max(pass, 1.0) / (static_cast<double>(weights.size()) + 1.0);
  sum += std::max(1.0 - listed, 0.0) * look_alikes;
  for (double& weight : weights) weight *= sum > 0.0 ? options_.max_probability / sum : 0.0;
  return weights;
}

std::optional<LidarStage::Answer> LidarStage::answer() const {
  if (matches_ == 0 || driven_m_ < options_.min_distance_m) return std::nullopt;
  const std::vector<double> shares = weights();
  const auto best = static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin());
  if (shares.empty() || hypotheses_[best].rejected || hypotheses_[best].low_scores > 0) return std::nullopt;
  const double survivors = std::accumulate(shares.begin(), shares.end(), 0.0);
  const bool due =
      shares[best] >= options_.answer_share * survivors || driven_m_ >= options_.answer_distance_m;
  if (!due) return std::nullopt;
  return Answer{hypotheses_[best].map_T_base, hypotheses_[best].covariance, shares[best]};
}

}  // namespace mstsl
