#include "mstsl/mapping/loop_closer.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "mstsl/scan/fit_to_walls.hpp"

#include "pose_difference.hpp"

namespace mstsl {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSpacing_m = 0.2;    // of a stretch's points
constexpr double kOneAnswer_m = 0.5;  // matches nearer each other say the same

/// What two rigid pieces of a drive can say of each other at best: 3 cm and a third of a degree.
Matrix3d least_covariance() { return Vector3d(9e-4, 9e-4, 3.6e-5).asDiagonal(); }

}  // namespace

void LoopCloser::begin_drive(const Eigen::Vector2d& magnetometer_base_m) {
  if (!open_.empty()) end_submap();
  stretch_.clear();
  ++drive_;
  magnetometer_base_m_ = magnetometer_base_m;
}

void LoopCloser::add(const Keyframe& keyframe) {
  open_.push_back(keyframe);
  stretch_.push_back(keyframe);
  while (keyframe.travelled_m - stretch_.front().travelled_m > options_.stretch_m) stretch_.pop_front();
  constexpr std::size_t kMost = 60;  // who turns on the spot all day
  while (stretch_.size() > kMost) stretch_.pop_front();
  ++keyframes_;
  const bool full =
      keyframe.travelled_m - open_.front().travelled_m >= options_.submap_m || open_.size() >= kMost;
  if (full) end_submap();
}

void LoopCloser::end_submap() {
  Submap submap;
  submap.drive = drive_, submap.magnetometer_base_m = magnetometer_base_m_;
  submap.last = keyframes_ - 1;
  submap.first = keyframes_ - open_.size();
  submap.origin = submap.first + open_.size() / 2;
  submap.begin_m = open_.front().travelled_m, submap.end_m = open_.back().travelled_m;
  const std::size_t middle = submap.origin - submap.first;
  for (const Keyframe& k : open_)
    submap.way_m.push_back(between(open_[middle].chain_T_base, k.chain_T_base).position());
  variogram_.add(stretch_of(open_, middle, magnetometer_base_m_, kSpacing_m).fields);
  submap.keyframes = std::move(open_);
  open_.clear();
  submaps_.push_back(std::move(submap));
}

std::vector<std::size_t> LoopCloser::near(const PoseGraph& graph,
                                          const std::vector<Matrix3d>& covariances) const {
  constexpr std::size_t kMost = 2;
  const Pose2& now = graph.pose(graph.size() - 1);
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t s = 0; s < submaps_.size(); ++s) {
    const Submap& submap = submaps_[s];
    const bool just_now =
        submap.drive == drive_ && stretch_.back().travelled_m - submap.end_m < options_.least_way_m;
    if (submap.keyframes.empty() || just_now) continue;
    const Eigen::Vector2d here_m = inverse(graph.pose(submap.origin)) * now.position();
    double distance_m = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& p : submap.way_m) distance_m = std::min(distance_m, (p - here_m).norm());
    const double sd_m = std::sqrt(covariances[submap.origin].topLeftCorner<2, 2>().trace());
    if (distance_m <= options_.nearest_m + std::min(2.0 * sd_m, options_.widest_m))
      found.emplace_back(distance_m + sd_m, s);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::size_t> nearest;
  for (std::size_t i = 0; i < std::min(kMost, found.size()); ++i) nearest.push_back(found[i].second);
  return nearest;
}

const SubmapWalls& LoopCloser::walls_of(std::size_t submap) {
  constexpr std::size_t kKept = 12;
  const auto at =
      std::find_if(ready_.begin(), ready_.end(), [&](const auto& r) { return r.first == submap; });
  if (at != ready_.end())
    ready_.splice(ready_.begin(), ready_, at);
  else
    ready_.emplace_front(submap, SubmapWalls(submaps_[submap]));
  if (ready_.size() > kKept) ready_.pop_back();
  return ready_.front().second;
}

std::vector<Closure> LoopCloser::look(const PoseGraph& graph) {
  std::vector<Closure> closures;
  if (stretch_.empty() || submaps_.empty()) return closures;
  const Keyframe& last = stretch_.back();
  const double way_m = last.travelled_m - stretch_.front().travelled_m;
  if (last.travelled_m - looked_at_m_ < options_.look_every_m || way_m < 0.75 * options_.stretch_m)
    return closures;
  looked_at_m_ = last.travelled_m;
  const std::vector<Matrix3d> covariances = graph.covariances_from_last();
  const std::vector<Keyframe> keyframes(stretch_.begin(), stretch_.end());
  const Stretch stretch = stretch_of(keyframes, keyframes.size() - 1, magnetometer_base_m_, kSpacing_m);
  for (const std::size_t s : near(graph, covariances)) {
    const std::size_t origin = submaps_[s].origin;
    const Pose2 origin_T_base = between(graph.pose(origin), graph.pose(graph.size() - 1));
    // The covariance is that of base_T_origin, in the base's axes; of the inverse motion, in the origin's:
    Matrix3d j = Matrix3d::Zero();
    j.topLeftCorner<2, 2>() = -origin_T_base.rotation();
    j.topRightCorner<2, 1>() = Eigen::Vector2d(origin_T_base.y, -origin_T_base.x);
    j(2, 2) = -1.0;
    const PosePrior prior{origin_T_base, j * covariances[origin] * j.transpose() + 4.0 * least_covariance()};
    ++counts_.looked_at;
    if (const auto closure = close(s, stretch, prior)) {
      closures.push_back(*closure);
      let_go_where_known(s, *closure);
    }
  }
  return closures;
}

std::vector<LoopCloser::Match> LoopCloser::matches(const SubmapWalls& walls, const Stretch& stretch,
                                                   const PosePrior& prior) const {
  std::vector<Match> matches;
  if (!walls.cells) return matches;
  SearchWindow window =
      SearchWindow::around(prior.mean, prior.covariance, options_.sigmas, walls.cells->occupancy.geometry());
  window.reach_m = window.reach_m.cwiseMin(options_.widest_m);
  window.reach_rad = std::min(window.reach_rad, options_.widest_rad);
  const PoseSearchOptions search{
      .min_score = options_.min_score, .distinct_m = 0.5, .distinct_rad = 0.15, .max_answers = 12};
  const PointSet points = at_most(stretch.points_m, 300);
  const Matrix3d prior_information = prior.covariance.inverse();
  for (const ScoredPose& found : search_poses(walls.cells->pyramid, points, window, search)) {
    const PosePrior around = PosePrior::isotropic(found.map_T_base, 0.15, 0.05);
    const WallFit fit = fit_to_walls(walls.walls, points, around, {.sigma_m = 0.1, .max_iterations = 10});
    if (fit.score < options_.min_score) continue;
    const bool known = std::any_of(matches.begin(), matches.end(), [&](const Match& m) {
      return distance(m.origin_T_base, fit.map_T_base) < 0.3 &&
             std::abs(angle_between(m.origin_T_base.yaw, fit.map_T_base.yaw)) < 0.1;
    });
    if (known) continue;
    Match match{fit.map_T_base, {}, fit.score, 0.0, 0.0};
    // Along what the scans leave open it is known as well as the graph had it.
    match.covariance = (fit.information + prior_information).inverse() + least_covariance();
    const Vector3d e = difference(prior.mean, fit.map_T_base);
    match.log_prior = -0.5 * e.dot(prior_information * e);
    matches.push_back(match);
  }
  return matches;
}

void LoopCloser::along_what_scans_leave_open(const SubmapWalls& walls, const Stretch& stretch,
                                             const PosePrior& prior, std::vector<Match>& matches) const {
  constexpr double kOpen_m = 0.12, kStep_m = 0.1;
  const Matrix3d prior_information = prior.covariance.inverse();
  std::vector<Match> more;
  for (const Match& match : matches) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(match.covariance.topLeftCorner<2, 2>());
    const double sd_m = std::sqrt(eigen.eigenvalues().y());
    if (sd_m < kOpen_m) continue;
    const Eigen::Vector2d along = eigen.eigenvectors().col(1);
    const int steps = static_cast<int>(std::min(3.0 * sd_m, 6.0) / kStep_m);
    for (int i = -steps; i <= steps; ++i) {
      Match shifted = match;
      shifted.origin_T_base =
          Pose2::from(match.origin_T_base.position() + i * kStep_m * along, match.origin_T_base.yaw);
      shifted.score = wall_score(walls.walls, at_most(stretch.points_m, 300), shifted.origin_T_base, 0.1);
      const Vector3d e = difference(prior.mean, shifted.origin_T_base);
      shifted.log_prior = -0.5 * e.dot(prior_information * e);
      Matrix3d narrow = Matrix3d::Zero();
      narrow.topLeftCorner<2, 2>() = along * along.transpose() / (kStep_m * kStep_m);
      shifted.covariance = (match.covariance.inverse() + narrow).inverse();
      more.push_back(shifted);
    }
  }
  for (Match& m : more) matches.push_back(m);
}

std::optional<Closure> LoopCloser::close(std::size_t s, const Stretch& stretch, const PosePrior& prior) {
  const SubmapWalls& walls = walls_of(s);
  std::vector<Match> found = matches(walls, stretch, prior);
  if (found.empty()) return std::nullopt;
  const auto log_weight = [&](const Match& m) {
    return m.log_prior + options_.points * (m.score - options_.even_score) + m.log_field;
  };
  struct Choice {
    std::size_t best = 0;
    double probability = 0.0;
  };
  // What lies within a few decimetres of the best says the same.
  const auto choose = [&](const std::vector<Match>& among) {
    Choice choice;
    for (std::size_t i = 1; i < among.size(); ++i)
      if (log_weight(among[i]) > log_weight(among[choice.best])) choice.best = i;
    const double most = log_weight(among[choice.best]);
    double same = 0.0, other = std::exp(std::min(700.0, -most));
    for (const Match& m : among)
      (distance(m.origin_T_base, among[choice.best].origin_T_base) < kOneAnswer_m ? same : other) +=
          std::exp(log_weight(m) - most);
    choice.probability = same / (same + other);
    return choice;
  };
  Choice choice = choose(found);
  const bool scans_alone = choice.probability >= options_.accepted_from;
  bool by_field = false;
  FieldEvidenceOptions field = options_.field;
  field.one_bias = submaps_[s].drive == drive_;
  if (options_.use_field && variogram_.is_known() && !stretch.fields.empty()) {
    along_what_scans_leave_open(walls, stretch, prior, found);
    for (Match& m : found) {
      const FieldEvidence evidence =
          field_evidence(walls.fields, stretch.fields, m.origin_T_base, variogram_, field);
      m.log_field = evidence.log_ratio;
      by_field |= evidence.compared_m > 0.5;
    }
    choice = choose(found);
  }
  const bool accepted = choice.probability >= options_.accepted_from;
  if (scans_alone && !accepted) ++counts_.refused_by_field;
  if (!scans_alone && accepted) ++counts_.earlier_by_field;
  if (!accepted) {
    if (log_weight(found[choice.best]) > 3.0) ++counts_.ambiguous;
    return std::nullopt;
  }
  ++counts_.accepted;
  // Matches shifted along what the scans leave open: the answer is their mean.
  const Match& best = found[choice.best];
  Vector3d mean(0, 0, 0);
  Matrix3d spread = Matrix3d::Zero();
  double weights = 0.0;
  for (const Match& m : found) {
    if (distance(m.origin_T_base, best.origin_T_base) >= kOneAnswer_m) continue;
    const double w = std::exp(log_weight(m) - log_weight(best));
    const Vector3d e = difference(best.origin_T_base, m.origin_T_base);
    mean += w * e, spread += w * e * e.transpose(), weights += w;
  }
  mean /= weights;
  Closure closure;
  closure.from = submaps_[s].origin, closure.to = keyframes_ - 1;
  closure.from_T_to =
      Pose2::from(best.origin_T_base.position() + mean.head<2>(), best.origin_T_base.yaw + mean.z());
  closure.information = (best.covariance + spread / weights - mean * mean.transpose()).inverse();
  closure.by_field = by_field, closure.probability = choice.probability;
  return closure;
}

void LoopCloser::let_go_where_known(std::size_t s, const Closure& closure) {
  // The newest whole submap shows what the older one shows if the robot went the same way: one is enough.
  if (submaps_.empty()) return;
  Submap& newest = submaps_.back();
  if (&newest == &submaps_[s] || newest.keyframes.empty()) return;
  if (stretch_.back().travelled_m - newest.end_m > options_.stretch_m) return;
  const Pose2 base_T_newest =
      between(stretch_.back().chain_T_base, newest.keyframes[newest.origin - newest.first].chain_T_base);
  const Pose2 there = closure.from_T_to * base_T_newest;
  constexpr double kNear_m = 0.75, kAlike_rad = 0.8;
  double distance_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p : submaps_[s].way_m)
    distance_m = std::min(distance_m, (p - there.position()).norm());
  if (distance_m < kNear_m && std::abs(there.yaw) < kAlike_rad) {
    ready_.remove_if([&](const auto& r) { return r.first + 1 == submaps_.size(); });
    newest.keyframes.clear();
    newest.keyframes.shrink_to_fit();
  }
}

std::size_t LoopCloser::keyframes_kept() const {
  std::size_t kept = open_.size() + stretch_.size();
  for (const Submap& s : submaps_) kept += s.keyframes.size();
  return kept;
}

}  // namespace mstsl
