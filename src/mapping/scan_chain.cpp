#include "mstsl/mapping/scan_chain.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mstsl/localize/motion.hpp"

namespace mstsl {
namespace {

/// Thinned and not too many, each with its direction.
std::vector<FacedPoint> chosen(std::vector<BeamReturn> returns, const ScanChainOptions& options) {
  std::erase_if(returns,
                [&](const BeamReturn& r) { return (r.point_m - r.origin_m).norm() > options.max_range_m; });
  std::vector<FacedPoint> kept;
  PointSet places;
  for (const FacedPoint& p : faced_points(returns)) {
    if (!places.empty() && (places.back() - p.point_m).norm() < options.spacing_m) continue;
    places.push_back(p.point_m);
    kept.push_back(p);
  }
  if (kept.size() <= options.max_points) return kept;
  std::vector<FacedPoint> fewer;
  for (std::size_t i = 0; i < options.max_points; ++i)
    fewer.push_back(kept[i * kept.size() / options.max_points]);
  return fewer;
}

Eigen::Matrix3d in_base(const Eigen::Matrix3d& information_in_map, double yaw_rad) {
  Eigen::Matrix3d map_R_base = Eigen::Matrix3d::Identity();
  map_R_base.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(yaw_rad).toRotationMatrix();
  return map_R_base.transpose() * information_in_map * map_R_base;
}

}  // namespace

ScanChain::ScanChain(const Rig& rig, const ScanChainOptions& options)
    : rig_(rig),
      options_(options),
      stations_(rig, options.stations),
      walls_(options.recent_m, options.walls) {}

void ScanChain::observe(const OdometryReading& odometry) {
  track_.add(odometry);
  const auto pose = track_.at(odometry.stamp);
  if (pose && (odometry_.empty() || odometry.stamp > odometry_.back().stamp))
    odometry_.push_back({odometry.stamp, *pose});
  take_waiting(false);
}

void ScanChain::observe(const LaserScan& scan) {
  ++scans_;
  if (waiting_scans_.empty() || scan.stamp > waiting_scans_.back().stamp) waiting_scans_.push_back(scan);
  take_waiting(false);
}

void ScanChain::observe(const FieldReading& field) {
  if (!field.sensor_field_uT.allFinite()) return;
  if (waiting_fields_.empty() || field.stamp > waiting_fields_.back().stamp) waiting_fields_.push_back(field);
}

void ScanChain::take_waiting(bool now) {
  constexpr double kPatience_s = 3.0;
  while (!waiting_scans_.empty()) {
    const LaserScan& scan = waiting_scans_.front();
    const Stamp end = scan.stamp + sweep_duration_s(scan);
    const bool too_old = waiting_scans_.back().stamp - scan.stamp > kPatience_s;
    if (!now && !too_old && !track_.covers(end)) return;
    const auto track_T_base = track_.at(scan.stamp), track_T_end = track_.at(end);
    if (track_T_base && is_due(scan.stamp, *track_T_base)) {
      take_fields(scan.stamp);
      add(scan, *track_T_base, track_T_end.value_or(*track_T_base));
    }
    waiting_scans_.pop_front();
  }
  if (!odometry_.empty() && !waiting_fields_.empty() &&
      odometry_.back().stamp - waiting_fields_.front().stamp > kPatience_s)
    take_fields(waiting_fields_.front().stamp + 0.5 * kPatience_s);
}

void ScanChain::take_fields(Stamp until) {
  for (; !waiting_fields_.empty() && waiting_fields_.front().stamp <= until; waiting_fields_.pop_front())
    if (const auto at = track_.at(waiting_fields_.front().stamp)) stations_.add(waiting_fields_.front(), *at);
}

bool ScanChain::moved(const Pose2& from, const Pose2& to, double share) const {
  return distance(from, to) >= share * options_.keyframe_m ||
         std::abs(angle_between(from.yaw, to.yaw)) >= share * options_.keyframe_rad;
}

bool ScanChain::is_due(Stamp stamp, const Pose2& track_T_base) const {
  return !at_ || stamp - at_->stamp >= options_.matched_s ||
         moved(at_->track_T_base, track_T_base, options_.matched_share) || track_.breaks() != breaks_at_last_;
}

WallFit ScanChain::matched(const PointSet& points, const PosePrior& prior) const {
  WallFit best = fit_to_walls(walls_.walls(), points, prior, options_.fit);
  const auto consider = [&](const WallFit& fit, double gain) {
    if (fit.score > best.score + gain) best = fit;
  };
  // Wheels that slipped, or whose readings got lost, are off by more than their usual error.
  const Eigen::Matrix3d wide = options_.slipped * options_.slipped * prior.covariance;
  consider(fit_to_walls(walls_.walls(), points, {prior.mean, wide}, options_.fit), options_.slip_gain);
  if (best.score >= options_.search_below) return best;
  constexpr Surroundings kNear{.steps = 1, .step_m = 0.2, .corners = true, .turns = 3, .turn_rad = 0.04};
  consider(fit_around(walls_.walls(), points, prior.mean, kNear, options_.fit), options_.search_gain);
  return best;
}

WallFit ScanChain::found_again(const PointSet& points, const Pose2& about, double silent_s) const {
  // Never as far as the half turn that looks the same in a corridor.
  const double most_rad = std::min(radians(100.0), options_.turn_rad_s * silent_s);
  const double most_m = std::min(1.0, options_.speed_m_s * silent_s);
  Surroundings around{.step_m = 0.25, .corners = true, .turn_rad = 0.06};
  around.steps = static_cast<int>(std::ceil(most_m / around.step_m));
  around.turns = static_cast<int>(std::ceil(most_rad / around.turn_rad));
  return fit_around(walls_.walls(), points, about, around, options_.fit);
}

double ScanChain::longest_silence_s(Stamp stamp) const {
  double longest_s = 0.0;
  if (!at_) return longest_s;
  Stamp later = stamp;
  for (auto at = odometry_.rbegin(); at != odometry_.rend(); ++at) {
    if (at->stamp > later) continue;
    longest_s = std::max(longest_s, later - at->stamp);
    if (at->stamp <= at_->stamp) break;
    later = at->stamp;
  }
  return longest_s;
}

void ScanChain::add(const LaserScan& scan, const Pose2& track_T_base, const Pose2& track_T_end) {
  Keyframe keyframe{.stamp = scan.stamp, .travelled_m = track_.travelled_m(), .track_T_base = track_T_base};
  keyframe.points_base_m =
      chosen(beam_returns(scan, rig_.base_T_laser, between(track_T_base, track_T_end)), options_);
  const bool broken = track_.breaks() != breaks_at_last_;
  breaks_at_last_ = track_.breaks();
  const double silent_s = broken ? options_.break_s : longest_silence_s(scan.stamp);
  broken_since_keyframe_ |= silent_s > options_.silence_s;
  if (at_) place(keyframe, silent_s);
  const bool is_keyframe = !last_keyframe_ || broken_since_keyframe_ ||
                           moved(last_keyframe_->track_T_base, track_T_base, 1.0) ||
                           moved(last_keyframe_->chain_T_base, keyframe.chain_T_base, 1.0);
  at_ = At{scan.stamp, track_T_base, keyframe.chain_T_base};
  matched_scans_.push_back({scan.stamp, keyframe.chain_T_base});
  if (!is_keyframe) return;
  keyframe.broken = std::exchange(broken_since_keyframe_, false);
  keyframe.stations = stations_.take(track_T_base);
  walls_.add(keyframe.points_base_m, keyframe.chain_T_base);
  last_keyframe_ = at_;
  made_.push_back(std::move(keyframe));
}

void ScanChain::place(Keyframe& keyframe, double silent_s) const {
  const Pose2 motion = wheels_.corrected(between(at_->track_T_base, keyframe.track_T_base));
  const PosePrior prior{at_->chain_T_base * motion,
                        in_map(at_->chain_T_base, options_.odometry.covariance(motion))};
  const PointSet points = places_of(keyframe.points_base_m);
  WallFit fit = matched(points, prior);
  if (silent_s > options_.silence_s && fit.score < options_.lost_below) {
    const WallFit again = found_again(points, prior.mean, silent_s);
    if (again.score > options_.search_below) fit = again;
  }
  keyframe.score = fit.score;
  keyframe.chain_T_base = fit.score < options_.least_score ? prior.mean : fit.map_T_base;
  if (fit.score >= options_.least_score)
    keyframe.scan_information = in_base(fit.information, fit.map_T_base.yaw);
}

std::vector<Keyframe> ScanChain::take() { return std::exchange(made_, {}); }

}  // namespace mstsl
