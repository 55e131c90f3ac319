#include "mstsl/localize/baselines/global_scan.hpp"

#include <cmath>
#include <utility>

#include "mstsl/scan/branch_and_bound.hpp"

namespace mstsl {

GlobalScan::GlobalScan(std::shared_ptr<const LocalizationMaps> maps, const Rig& rig,
                       const GlobalScanOptions& options)
    : maps_(std::move(maps)), rig_(rig), options_(options), track_(options.odometry) {}

bool GlobalScan::worth_processing(Stamp stamp, const Pose2& track_T_base) const {
  if (!last_step_) return true;
  return distance(last_step_->pose, track_T_base) >= options_.process_every_m ||
         std::abs(angle_between(last_step_->pose.yaw, track_T_base.yaw)) >= options_.process_every_rad ||
         stamp - last_step_->stamp >= options_.process_every_s;
}

void GlobalScan::observe(const LaserScan& scan) {
  if (last_scan_ && scan.stamp <= *last_scan_) return;
  last_scan_ = scan.stamp;
  const std::optional<Pose2> track_T_base = track_.at(scan.stamp);
  if (!track_T_base || !worth_processing(scan.stamp, *track_T_base)) return;
  const std::optional<Pose2> track_T_end = track_.at(scan.stamp + sweep_duration_s(scan));
  PointSet points =
      points_in_base(scan, rig_.base_T_laser, track_T_end ? between(*track_T_base, *track_T_end) : Pose2{});
  if (points.size() < options_.min_returns) points.clear();
  const Pose2 last_T_base = last_step_ ? between(last_step_->pose, *track_T_base) : Pose2{};
  const bool broken = last_step_ && track_.breaks() != breaks_at_last_step_;
  last_step_ = {scan.stamp, *track_T_base};
  breaks_at_last_step_ = track_.breaks();
  travelled_at_last_step_m_ = track_.travelled_m();

  if (!tracker_) return search(points, last_T_base, broken);
  tracker_->observe(points, last_T_base, broken);
  if (!tracker_->lost()) return;
  ++times_lost_;
  tracker_.reset();
  candidate_.reset();
  last_try_m_.reset();
}

std::optional<GlobalScan::Match> GlobalScan::match(const PointSet& points_base_m) const {
  const PointSet points = at_most(thinned(points_base_m, options_.spacing_m), options_.max_points);
  PoseSearchOptions search;
  search.min_score = options_.min_score;
  const auto found = search_poses(maps_->walls->pyramid, points,
                                  SearchWindow::whole(maps_->walls->field.geometry()), search);
  if (found.empty()) return std::nullopt;
  // The lattice's cells are 5 cm; the prior is far wider and leaves the word to the scan.
  constexpr double kWide_m = 0.2, kWide_rad = 0.1;
  const Pose2& start = found.front().map_T_base;
  return Match{
      refine_pose(maps_->walls->field, points, start, PosePrior::isotropic(start, kWide_m, kWide_rad)),
      found.front().score};
}

void GlobalScan::search(const PointSet& points_base_m, const Pose2& last_T_base, bool broken) {
  if (broken) candidate_.reset();
  if (candidate_) candidate_->map_T_base = candidate_->map_T_base * last_T_base;
  if (last_try_m_ && track_.travelled_m() - *last_try_m_ < options_.try_every_m) return;
  if (points_base_m.empty()) return;
  last_try_m_ = track_.travelled_m();
  ++searches_;
  const std::optional<Match> found = match(points_base_m);
  if (!found) {
    candidate_.reset();
    return;
  }
  const Pose2& pose = found->refined.map_T_base;
  const bool agrees = candidate_ && distance(candidate_->map_T_base, pose) <= options_.agree_m &&
                      std::abs(angle_between(candidate_->map_T_base.yaw, pose.yaw)) <= options_.agree_rad;
  candidate_ = Candidate{pose, agrees ? candidate_->agreeing + 1 : 1};
  score_ = found->score;
  if (candidate_->agreeing < options_.agreeing) return;
  was_localized_ = true;
  tracker_.emplace(maps_, pose, found->refined.covariance, options_.tracker);
}

Estimate GlobalScan::estimate() const {
  Estimate estimate;
  if (!last_step_) return estimate;
  estimate.stamp = last_step_->stamp;
  estimate.travelled_m = travelled_at_last_step_m_;
  estimate.status = tracker_         ? LocalizationStatus::kLocalized
                    : was_localized_ ? LocalizationStatus::kLost
                                     : LocalizationStatus::kSearching;
  if (tracker_) {
    estimate.map_T_base = tracker_->map_T_base();
    estimate.covariance = tracker_->covariance();
    estimate.probability = score_;
    estimate.hypotheses = {{tracker_->map_T_base(), score_}};
  } else if (candidate_) {
    estimate.hypotheses = {{candidate_->map_T_base, score_}};
  }
  return estimate;
}

LocalizerReport GlobalScan::report() const {
  return {{{"searches of the whole map", searches_}, {"times lost", times_lost_}}, {}};
}

}  // namespace mstsl
