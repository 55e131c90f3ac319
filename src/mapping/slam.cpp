#include "mstsl/mapping/slam.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/LU>

#include "mstsl/mapping/bent_track.hpp"

namespace mstsl {
namespace {

Eigen::Matrix3d turned(const Eigen::Matrix3d& information, double yaw_rad) {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  r.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(yaw_rad).toRotationMatrix();
  return r * information * r.transpose();
}

/// Wheels err the same way for many steps; counted as if each step erred anew they would say too much.
constexpr double kWheelsAgain = 4.0;

}  // namespace

Slam::Slam(const Rig& rig, const SlamOptions& options)
    : options_(options),
      chain_(rig, options.chain),
      loops_(rig.base_T_magnetometer.translation().head<2>(), options.loops),
      graph_(options.graph) {}

void Slam::advance() {
  for (const Keyframe& keyframe : chain_.take()) add(keyframe);
}

void Slam::add(const Keyframe& keyframe) {
  ChainLink link;
  if (!kept_.empty()) {
    const Kept& last = kept_.back();
    link.by_wheels = between(last.track_T_base, keyframe.track_T_base);
    Eigen::Matrix3d covariance = kWheelsAgain * options_.chain.odometry.covariance(link.by_wheels);
    if (keyframe.broken) covariance += Eigen::Vector3d(1.0, 1.0, 2.0).asDiagonal();
    link.wheels_information = covariance.inverse();
    link.by_scans = between(last.chain_T_base, keyframe.chain_T_base);
    link.scans_information = turned(keyframe.scan_information, link.by_scans.yaw);
  }
  graph_.add(link);
  kept_.push_back({keyframe.stamp, keyframe.track_T_base, keyframe.chain_T_base, keyframe.score});
  loops_.add(keyframe);
  bool moves = false;
  for (const Closure& closure : loops_.look(graph_)) {
    constexpr double kMuch_m = 0.2, kMuch_rad = 0.03;
    const Pose2 now = between(graph_.pose(closure.from), graph_.pose(closure.to));
    moves |= distance(now, closure.from_T_to) > kMuch_m ||
             std::abs(angle_between(now.yaw, closure.from_T_to.yaw)) > kMuch_rad;
    graph_.add(closure);
    closed_since_ = true;
  }
  // A loop that moves the map does so at once; small improvements wait until the graph has grown by a tenth.
  if (moves || (closed_since_ && graph_.size() > optimised_at_ + std::max<std::size_t>(100, graph_.size() / 10)))
    optimise();
}

std::vector<TrackKnot> Slam::scans_on_track(const Trajectory& scans) const {
  Trajectory track;
  for (const TimedPose& at : chain_.odometry()) track.add(at.stamp, at.pose);
  std::vector<TrackKnot> knots;
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (const auto at = track.at(scans[i].stamp, std::numeric_limits<double>::infinity()))
      knots.push_back({scans[i].stamp, *at, scans[i].pose});
  return knots;
}

void Slam::optimise() {
  graph_.optimise();
  chain_.set_wheels(graph_.wheels());
  optimised_at_ = graph_.size();
  closed_since_ = false;
}

Result<SlamTrack> Slam::finish() {
  chain_.finish();
  advance();
  if (chain_.odometry().empty())
    return Error("there is no odometry to make a map with; name its topic, or map by scans alone");
  if (kept_.empty())
    return Error(chain_.scans() == 0 ? "there is no scan to make a map of; name the scans' topic"
                                     : "no scan was taken near a time with odometry; no map can be made");
  graph_.optimise();
  SlamTrack track;
  std::vector<TrackKnot> keyframes;
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    keyframes.push_back({kept_[i].stamp, kept_[i].chain_T_base, graph_.pose(i)});
    track.keyframes.push_back({kept_[i].stamp, graph_.pose(i)});
    track.mean_score += kept_[i].score / static_cast<double>(kept_.size());
  }
  track.map_T_base = bent_track(chain_.odometry(), scans_on_track(bent_track(chain_.matched_scans(), keyframes)));
  track.closures = graph_.closures();
  track.loops = loops_.counts();
  track.wheels = graph_.wheels();
  track.way_m = chain_.travelled_m();
  track.scans = chain_.scans(), track.breaks = chain_.breaks();
  return track;
}

}  // namespace mstsl
