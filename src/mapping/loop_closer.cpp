#include "mstsl/mapping/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/LU>

#include "loop_match.hpp"

namespace mstsl {

using Eigen::Matrix3d;

std::vector<LoopCloser::Nearby> LoopCloser::near(const PoseGraph& graph) const {
  const Pose2& now = graph.pose(graph.size() - 1);
  std::vector<Nearby> found;
  std::vector<std::size_t> origins;
  for (std::size_t s = 0; s < store_.submaps().size(); ++s) {
    const Submap& submap = store_.submaps()[s];
    const bool just_now = submap.drive == store_.drive() &&
                          store_.last_metres().back().travelled_m - submap.end_m < options_.least_way_m;
    if (submap.keyframes.empty() || just_now) continue;
    const double distance_m = submap.distance_m(inverse(graph.pose(submap.origin)) * now.position());
    if (distance_m > options_.nearest_m + options_.widest_m) continue;
    found.push_back({.submap = s, .distance_m = distance_m});
    origins.push_back(submap.origin);
  }
  const std::vector<Matrix3d> covariances = graph.covariances_from_last(origins);
  for (std::size_t i = 0; i < found.size(); ++i) found[i].covariance = covariances[i];
  std::erase_if(found, [&](const Nearby& n) {
    return n.distance_m > options_.nearest_m + std::min(2.0 * n.sd_m(), options_.widest_m);
  });
  std::stable_sort(found.begin(), found.end(), [](const Nearby& a, const Nearby& b) {
    return a.distance_m + a.sd_m() < b.distance_m + b.sd_m();
  });
  return found;
}

std::vector<Closure> LoopCloser::look(const PoseGraph& graph) {
  std::vector<Closure> closures;
  if (store_.last_metres().empty() || store_.submaps().empty()) return closures;
  const Keyframe& last = store_.last_metres().back();
  const double way_m = last.travelled_m - store_.last_metres().front().travelled_m;
  if (last.travelled_m - looked_at_m_ < options_.look_every_m || way_m < 0.75 * options_.submaps.stretch_m)
    return closures;
  looked_at_m_ = last.travelled_m;
  const Stretch stretch = store_.stretch();
  const std::vector<Nearby> all = near(graph);
  constexpr std::size_t kMost = 2;
  for (const Nearby& nearby : std::span(all).first(std::min(kMost, all.size()))) {
    const std::size_t origin = store_.submaps()[nearby.submap].origin;
    const Pose2 origin_T_base = between(graph.pose(origin), graph.pose(graph.size() - 1));
    // The covariance is that of base_T_origin, in the base's axes; of the inverse motion, in the origin's:
    Matrix3d j = Matrix3d::Zero();
    j.topLeftCorner<2, 2>() = -origin_T_base.rotation();
    j.topRightCorner<2, 1>() = Eigen::Vector2d(origin_T_base.y, -origin_T_base.x);
    j(2, 2) = -1.0;
    const PosePrior prior{origin_T_base, j * nearby.covariance * j.transpose() + 4.0 * least_covariance()};
    ++counts_.looked_at;
    if (const auto closure = close(nearby.submap, stretch, prior)) closures.push_back(*closure);
  }
  if (closures.empty()) return closures;
  std::vector<std::size_t> known;
  constexpr double kKnown_m = 0.25;
  for (const Nearby& nearby : all)
    if (nearby.sd_m() < kKnown_m) known.push_back(nearby.submap);
  store_.let_go_where_known(known, graph);
  return closures;
}

std::optional<Closure> LoopCloser::close(std::size_t s, const Stretch& stretch, const PosePrior& prior) {
  const SubmapWalls& walls = store_.walls_of(s);
  std::vector<LoopMatch> found = loop_matches(walls, stretch, prior, options_);
  if (found.empty()) return std::nullopt;
  LoopChoice choice = choose(found, options_);
  const bool scans_alone = choice.probability >= options_.accepted_from;
  bool by_field = false;
  FieldEvidenceOptions field = options_.field;
  field.one_bias = store_.submaps()[s].drive == store_.drive();
  if (options_.use_field && store_.variogram().is_known() && !stretch.fields.empty()) {
    add_along_what_scans_leave_open(walls, stretch, prior, found);
    for (LoopMatch& m : found) {
      const FieldEvidence evidence =
          field_evidence(walls.fields, stretch.fields, m.origin_T_base, store_.variogram(), field);
      m.log_field = evidence.log_ratio;
      by_field |= evidence.compared_m > 0.5;
    }
    choice = choose(found, options_);
  }
  const bool accepted = choice.probability >= options_.accepted_from;
  if (scans_alone && !accepted) ++counts_.refused_by_field;
  if (!scans_alone && accepted) ++counts_.earlier_by_field;
  if (!accepted) {
    if (found[choice.best].log_weight(options_) > 3.0) ++counts_.ambiguous;
    return std::nullopt;
  }
  ++counts_.accepted;
  const LoopPose pose = pose_of(found, choice.best, options_);
  return Closure{.from = store_.submaps()[s].origin,
                 .to = store_.keyframes() - 1,
                 .from_T_to = pose.origin_T_base,
                 .information = pose.covariance.inverse(),
                 .by_field = by_field,
                 .probability = choice.probability};
}

}  // namespace mstsl
