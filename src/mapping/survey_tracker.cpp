#include "mstsl/mapping/survey_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "mstsl/localize/motion.hpp"
#include "mstsl/mapping/bent_track.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Pose2 moved(const Pose2& pose, const Vector3d& by) {
  return Pose2::from(pose.position() + by.head<2>(), pose.yaw + by.z());
}

/// A scan with fewer of its points on walls says nothing of where it was taken.
constexpr double kLeastScore = 0.25;

}  // namespace

SurveyTracker::SurveyTracker(std::shared_ptr<const WallField> walls, const Rig& rig,
                             const Pose2& initial_map_T_base, const SurveyTrackerOptions& options)
    : walls_(std::move(walls)), rig_(rig), initial_(initial_map_T_base), options_(options) {}

void SurveyTracker::observe(const OdometryReading& odometry) {
  queue_.observe(odometry);
  take_waiting(false);
}

void SurveyTracker::observe(const LaserScan& scan) {
  queue_.observe(scan);
  take_waiting(false);
}

void SurveyTracker::take_waiting(bool now) {
  while (const std::optional<PlacedScan> placed = queue_.next(now))
    if (due(placed->scan.stamp, placed->track_T_base)) match(*placed);
}

bool SurveyTracker::due(Stamp stamp, const Pose2& track_T_base) const {
  if (nodes_.empty()) return true;
  const Node& last = nodes_.back();
  return stamp > last.stamp &&
         (distance(last.track_T_base, track_T_base) >= options_.match_every_m ||
          std::abs(angle_between(last.track_T_base.yaw, track_T_base.yaw)) >= options_.match_every_rad ||
          stamp - last.stamp >= options_.match_every_s);
}

void SurveyTracker::match(const PlacedScan& placed) {
  if (error_) return;
  const auto& [scan, track_T_base, track_T_end] = placed;
  const PointSet all = points_in_base(scan, rig_.base_T_laser, between(track_T_base, track_T_end));
  const PointSet points = at_most(thinned(all, options_.spacing_m), options_.max_points);
  if (nodes_.empty())
    start(points, scan.stamp, track_T_base);
  else
    go_on(points, scan.stamp, track_T_base);
}

void SurveyTracker::start(const PointSet& points, Stamp stamp, const Pose2& track_T_base) {
  if (points.empty()) return;  // a blind scan: the next one will do
  const WallFit fit = fit_around(*walls_, points, initial_, options_.at_start, options_.fit);
  if (fit.score < options_.lost_below) {
    error_ =
        Error(fmt::format("the first scan fits the map nowhere near the initial pose ({:g}, {:g}, {:g}): at "
                          "best {:.0f} % of its "
                          "points lie on walls; check the pose, the map and the laser's mounting",
                          initial_.x, initial_.y, initial_.yaw, 100 * fit.score));
    return;
  }
  const Matrix3d prior = 4.0 * options_.at_start.spread();
  const Matrix3d covariance = (prior.inverse() + fit.information).inverse();
  nodes_.push_back({stamp, track_T_base, fit.map_T_base, fit.map_T_base, prior, covariance,
                    Matrix3d::Identity(), fit.score});
  breaks_at_last_ = queue_.track().breaks();
}

void SurveyTracker::go_on(const PointSet& points, Stamp stamp, const Pose2& track_T_base) {
  const Node& last = nodes_.back();
  const Pose2 motion = between(last.track_T_base, track_T_base);
  Node node{stamp, track_T_base, last.map_T_base * motion, {}, {}, {}, Matrix3d::Identity(), 0.0};
  node.by_last = by_pose_before(last.map_T_base, motion);
  node.predicted_covariance = node.by_last * last.covariance * node.by_last.transpose() +
                              in_map(last.map_T_base, options_.odometry.covariance(motion));
  if (queue_.track().breaks() != breaks_at_last_) node.predicted_covariance += options_.at_start.spread();
  breaks_at_last_ = queue_.track().breaks();

  WallFit fit = fit_to_walls(*walls_, points, {node.predicted, node.predicted_covariance}, options_.fit);
  if (!points.empty() && fit.score < options_.search_below) {
    const WallFit around = fit_around(*walls_, points, node.predicted, {}, options_.fit);
    if (around.score > fit.score + options_.search_gain) {
      node.predicted_covariance += Surroundings{}.spread();
      fit = around;
    }
  }
  const Matrix3d information = fit.score < kLeastScore ? Matrix3d(Matrix3d::Zero()) : fit.information;
  node.map_T_base = fit.score < kLeastScore ? node.predicted : fit.map_T_base;
  node.covariance = (node.predicted_covariance.inverse() + information).inverse();
  node.score = fit.score;
  if (!points.empty()) watch(node, std::hypot(motion.x, motion.y));
  nodes_.push_back(node);
}

void SurveyTracker::watch(const Node& node, double moved_m) {
  lost_for_m_ = node.score < options_.lost_below ? lost_for_m_ + moved_m : 0.0;
  if (lost_for_m_ < options_.lost_after_m) return;
  error_ =
      Error(fmt::format("the survey was lost at {:.2f} s near ({:.1f}, {:.1f}) m: its scans do not fit the "
                        "map for {:g} m; is this "
                        "the map of that building, and does the log begin at the initial pose?",
                        node.stamp.seconds(), node.map_T_base.x, node.map_T_base.y, options_.lost_after_m));
}

void SurveyTracker::smooth() {
  for (std::size_t i = nodes_.size() - 1; i-- > 0;) {
    Node& node = nodes_[i];
    const Node& next = nodes_[i + 1];
    const Matrix3d gain = node.covariance * next.by_last.transpose() * next.predicted_covariance.inverse();
    node.map_T_base = moved(node.map_T_base, gain * difference(next.predicted, next.map_T_base));
    node.covariance += gain * (next.covariance - next.predicted_covariance) * gain.transpose();
  }
}

SurveyTrack SurveyTracker::between_scans() const {
  SurveyTrack track;
  track.scans = nodes_.size();
  track.way_m = queue_.track().travelled_m();
  for (const Node& node : nodes_) {
    const double variance = node.covariance.topLeftCorner<2, 2>().trace();
    track.mean_score += node.score / static_cast<double>(nodes_.size());
    track.typical_sd_m += variance / static_cast<double>(nodes_.size());
    track.worst_sd_m = std::max(track.worst_sd_m, std::sqrt(variance));
  }
  track.typical_sd_m = std::sqrt(track.typical_sd_m);
  std::vector<TrackKnot> knots;
  for (const Node& node : nodes_) knots.push_back({node.stamp, node.track_T_base, node.map_T_base});
  track.map_T_base = bent_track(queue_.odometry(), knots);
  return track;
}

Result<SurveyTrack> SurveyTracker::finish() {
  take_waiting(true);
  if (error_) return *error_;
  if (queue_.odometry().empty())
    return Error("there is no odometry to track the survey with; name its topic, or give --pose-topic");
  if (nodes_.empty())
    return Error(queue_.scans_seen() == 0
                     ? "there is no scan to track the survey with; name the scans' topic"
                     : "no scan has a return near a time with odometry; the survey cannot be tracked");
  smooth();
  return between_scans();
}

}  // namespace mstsl
