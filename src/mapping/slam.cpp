#include "mstsl/mapping/slam.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <Eigen/LU>

namespace mstsl {
namespace {

constexpr double kAnyGap_s = std::numeric_limits<double>::infinity();

Eigen::Matrix3d turned(const Eigen::Matrix3d& information, double yaw_rad) {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  r.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(yaw_rad).toRotationMatrix();
  return r * information * r.transpose();
}

/// Wheels err the same way for many steps; counted as if each step erred anew they would say too much.
constexpr double kWheelsAgain = 4.0;

Trajectory trajectory_of(const std::vector<TimedPose>& poses) {
  Trajectory trajectory;
  for (const TimedPose& at : poses) trajectory.add(at.stamp, at.pose);
  return trajectory;
}

}  // namespace

double SlamTrack::way_m() const {
  double way_m = 0.0;
  for (const DriveTrack& drive : drives) way_m += drive.way_m;
  return way_m;
}

std::size_t SlamTrack::scans() const {
  std::size_t scans = 0;
  for (const DriveTrack& drive : drives) scans += drive.scans;
  return scans;
}

Slam::Slam(const SlamOptions& options) : options_(options), loops_(options.loops), graph_(options.graph) {}

void Slam::begin_drive(const Rig& rig, const std::optional<Anchor>& anchor) {
  const double begin_m = drives_.empty() ? 0.0 : drives_.back()->begin_m + chain().travelled_m();
  drives_.push_back(
      std::make_unique<Drive>(Drive{ScanChain(rig, options_.chain), {}, anchor, kept_.size(), begin_m}));
  if (options_.without_wheels) drives_.back()->laser_odometry.emplace(rig);
  loops_.begin_drive(rig.base_T_magnetometer.translation().head<2>());
}

void Slam::observe(const OdometryReading& odometry) {
  if (options_.without_wheels) return;
  chain().observe(odometry);
  advance();
}

void Slam::observe(const LaserScan& scan) {
  if (auto& laser = drives_.back()->laser_odometry)
    if (const auto reading = laser->observe(scan)) chain().observe(*reading);
  chain().observe(scan);
  advance();
}

void Slam::advance() {
  for (Keyframe& keyframe : chain().take()) add(std::move(keyframe));
}

void Slam::add(Keyframe keyframe) {
  Drive& drive = *drives_.back();
  keyframe.travelled_m += drive.begin_m;
  ChainLink link;
  if (kept_.size() > drive.first) {
    const Kept& last = kept_.back();
    link.by_wheels = between(last.track_T_base, keyframe.track_T_base);
    Eigen::Matrix3d covariance = kWheelsAgain * options_.chain.odometry.covariance(link.by_wheels);
    if (keyframe.broken) covariance += Eigen::Vector3d(1.0, 1.0, 2.0).asDiagonal();
    link.wheels_information = covariance.inverse();
    link.by_scans = between(last.chain_T_base, keyframe.chain_T_base);
    link.scans_information = turned(keyframe.scan_information, link.by_scans.yaw);
  }
  graph_.add(link);
  kept_.push_back(
      {drives_.size() - 1, keyframe.stamp, keyframe.track_T_base, keyframe.chain_T_base, keyframe.score});
  loops_.add(keyframe);
  if (drive.anchor && keyframe.stamp >= drive.anchor->stamp) use_anchor(drive);
  if (!drive.anchor) look();
}

void Slam::use_anchor(Drive& drive) {
  const Anchor anchor = *std::exchange(drive.anchor, std::nullopt);
  if (drive.first == 0) return;
  const std::size_t last = kept_.size() - 1;
  const auto then = trajectory_of(drive.chain.matched_scans()).at(anchor.stamp, kAnyGap_s);
  const Pose2 now =
      anchor.map_T_base * between(then.value_or(kept_[last].chain_T_base), kept_[last].chain_T_base);
  graph_.move_tail(drive.first, last, now);
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < drive.first; ++i)
    if (distance(graph_.pose(i), now) < distance(graph_.pose(nearest), now)) nearest = i;
  Closure tie{.from = nearest, .to = last, .from_T_to = between(graph_.pose(nearest), now)};
  // The localizer's own map of the drives before was a little off too: 0.1 m and 1 deg.
  const Eigen::Matrix3d floor = Eigen::Vector3d(0.01, 0.01, 3e-4).asDiagonal();
  tie.information = turned((anchor.covariance + floor).inverse(), -graph_.pose(nearest).yaw);
  tie.by_field = true, tie.probability = 0.999;
  graph_.add(tie);
  closed_since_ = true;
}

void Slam::look() {
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
  if (moves ||
      (closed_since_ && graph_.size() > optimised_at_ + std::max<std::size_t>(100, graph_.size() / 10)))
    optimise();
}

void Slam::optimise() {
  graph_.optimise();
  chain().set_wheels(graph_.wheels());
  optimised_at_ = graph_.size();
  closed_since_ = false;
}

DriveTrack Slam::track_of(std::size_t d) const {
  const ScanChain& chain = drives_[d]->chain;
  std::vector<TrackKnot> keyframes;
  for (std::size_t i = drives_[d]->first; i < kept_.size() && kept_[i].drive == d; ++i)
    keyframes.push_back({kept_[i].stamp, kept_[i].chain_T_base, graph_.pose(i)});
  // First the matched scans between the keyframes, then odometry between the scans.
  const Trajectory scans = bent_track(chain.matched_scans(), keyframes),
                   track = trajectory_of(chain.odometry());
  std::vector<TrackKnot> knots;
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (const auto at = track.at(scans[i].stamp, kAnyGap_s))
      knots.push_back({scans[i].stamp, *at, scans[i].pose});
  if (knots.empty())
    knots.push_back({chain.odometry().front().stamp, track.front().pose, scans.front().pose});
  return {bent_track(chain.odometry(), knots), chain.travelled_m(), chain.scans(), chain.breaks()};
}

Result<SlamTrack> Slam::track() {
  chain().finish();
  advance();
  const Drive& last = *drives_.back();
  if (last.chain.odometry().empty())
    return Error("there is no odometry to make a map with; name its topic, or map by scans alone");
  if (kept_.size() == last.first)
    return Error(last.chain.scans() == 0 ? "there is no scan to make a map of; name the scans' topic"
                                         : "no scan was taken near a time with odometry; no map can be made");
  if (last.anchor && last.first > 0) return Error("the drive ended before it was known where it was");
  graph_.optimise();
  SlamTrack track;
  for (std::size_t d = 0; d < drives_.size(); ++d) track.drives.push_back(track_of(d));
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    track.keyframes.push_back({kept_[i].drive, kept_[i].stamp, graph_.pose(i)});
    track.mean_score += kept_[i].score / static_cast<double>(kept_.size());
  }
  track.closures = graph_.closures();
  track.loops = loops_.counts();
  track.wheels = graph_.wheels();
  return track;
}

}  // namespace mstsl
