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
  queue_.observe(odometry);
  take_waiting(false);
}

void ScanChain::observe(const LaserScan& scan) {
  queue_.observe(scan);
  take_waiting(false);
}

void ScanChain::observe(const FieldReading& field) {
  if (!field.sensor_field_uT.allFinite()) return;
  if (waiting_fields_.empty() || field.stamp > waiting_fields_.back().stamp) waiting_fields_.push_back(field);
}

void ScanChain::take_waiting(bool now) {
  while (const std::optional<PlacedScan> placed = queue_.next(now)) {
    if (!is_due(placed->scan.stamp, placed->track_T_base)) continue;
    take_fields(placed->scan.stamp);
    add(*placed);
  }
  constexpr double kPatience_s = 3.0;  // where no scan comes
  if (!odometry().empty() && !waiting_fields_.empty() &&
      odometry().back().stamp - waiting_fields_.front().stamp > kPatience_s)
    take_fields(waiting_fields_.front().stamp + 0.5 * kPatience_s);
}

void ScanChain::take_fields(Stamp until) {
  for (; !waiting_fields_.empty() && waiting_fields_.front().stamp <= until; waiting_fields_.pop_front())
    if (const auto at = queue_.track().at(waiting_fields_.front().stamp))
      stations_.add(waiting_fields_.front(), *at);
}

bool ScanChain::moved(const Pose2& from, const Pose2& to, double share) const {
  return distance(from, to) >= share * options_.keyframe_m ||
         std::abs(angle_between(from.yaw, to.yaw)) >= share * options_.keyframe_rad;
}

bool ScanChain::is_due(Stamp stamp, const Pose2& track_T_base) const {
  return !at_ || stamp - at_->stamp >= options_.matched_s ||
         moved(at_->track_T_base, track_T_base, options_.matched_share) || breaks() != breaks_at_last_;
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
  for (auto at = odometry().rbegin(); at != odometry().rend(); ++at) {
    if (at->stamp > later) continue;
    longest_s = std::max(longest_s, later - at->stamp);
    if (at->stamp <= at_->stamp) break;
    later = at->stamp;
  }
  return longest_s;
}

void ScanChain::add(const PlacedScan& placed) {
  const auto& [scan, track_T_base, track_T_end] = placed;
  Keyframe keyframe{.stamp = scan.stamp, .travelled_m = travelled_m(), .track_T_base = track_T_base};
  keyframe.points_base_m =
      chosen(beam_returns(scan, rig_.base_T_laser, between(track_T_base, track_T_end)), options_);
  const bool broken = breaks() != breaks_at_last_;
  breaks_at_last_ = breaks();
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
