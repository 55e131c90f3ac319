#include "mstsl/scan/local_map.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "mstsl/core/angles.hpp"
#include "mstsl/grid/frame.hpp"

namespace mstsl {
namespace {

GridGeometry square(const LocalMapOptions& options) {
  const int cells = static_cast<int>(std::ceil(2 * options.half_size_m / options.resolution_m));
  const double corner_m = -0.5 * cells * options.resolution_m;
  return {.resolution_m = options.resolution_m,
          .columns = cells,
          .rows = cells,
          .map_T_grid = {corner_m, corner_m, 0}};
}

/// The covariance of a * motion from that of the pose a (frame of a's parent) and of the motion (frame of a).
Eigen::Matrix3d propagated(const Eigen::Matrix3d& covariance, const Pose2& pose, const Pose2& motion,
                           const Eigen::Matrix3d& motion_covariance) {
  const Eigen::Vector2d way = pose.rotation() * motion.position();
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Identity();
  by_pose.topRightCorner<2, 1>() << -way.y(), way.x();
  Eigen::Matrix3d by_motion = Eigen::Matrix3d::Identity();
  by_motion.topLeftCorner<2, 2>() = pose.rotation();
  return by_pose * covariance * by_pose.transpose() + by_motion * motion_covariance * by_motion.transpose();
}

/// The returns that have a neighbouring beam's return near them.
std::vector<BeamReturn> dense_returns(const std::vector<BeamReturn>& returns, double max_gap_m) {
  std::vector<BeamReturn> dense;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const auto near = [&](std::size_t j) {
      return (returns[i].point_m - returns[j].point_m).norm() <= max_gap_m;
    };
    if ((i > 0 && near(i - 1)) || (i + 1 < returns.size() && near(i + 1))) dense.push_back(returns[i]);
  }
  return dense;
}

}  // namespace

Eigen::Matrix3d OdometryNoise::covariance(const Pose2& motion) const {
  const double way_m = motion.position().norm(), turn_rad = std::abs(motion.yaw);
  const double variance_m2 = std::pow(m_per_m * way_m, 2) + floor_m * floor_m;
  const double variance_rad2 =
      std::pow(rad_per_m * way_m, 2) + std::pow(rad_per_rad * turn_rad, 2) + floor_rad * floor_rad;
  return Eigen::Vector3d(variance_m2, variance_m2, variance_rad2).asDiagonal();
}

LocalMap::LocalMap(const LocalMapOptions& options)
    : options_(options), drawn_(square(options), options.beams), field_(occupancy(), options.likelihood) {}

void LocalMap::insert(const std::vector<BeamReturn>& returns_base, const Pose2& last_T_base) {
  const std::vector<BeamReturn> dense = dense_returns(returns_base, options_.max_gap_m);
  const PointSet points = thinned(end_points(dense), options_.spacing_m);
  if (has_scan_) align(points, last_T_base);
  if (points.empty() || (has_scan_ && !has_moved_since_drawn())) return;
  draw(dense, points);
  has_scan_ = true;
}

void LocalMap::align(const PointSet& points_base, const Pose2& last_T_base) {
  const PosePrior predicted{
      local_T_base_ * last_T_base,
      propagated(covariance_, local_T_base_, last_T_base, options_.odometry.covariance(last_T_base))};
  const auto aligned_from = [&](const Pose2& start, const PointSet& points) {
    return refine_pose(field_, at_most(points, options_.max_points), start, predicted, options_.refine);
  };
  // Points where the map has not looked yet would pull the scan back to the ends of the walls drawn so far: 5
  // % of the way along a bare corridor was lost to them. The first alignment tells which those are, the
  // second does without.
  const Refinement roughly = aligned_from(predicted.mean, points_base);
  const Refinement aligned =
      aligned_from(roughly.map_T_base, points_over_drawn(points_base, roughly.map_T_base));
  local_T_base_ = aligned.map_T_base;
  covariance_ = aligned.covariance;
}

PointSet LocalMap::points_over_drawn(const PointSet& points_base, const Pose2& local_T_base) const {
  const GridFrame frame(drawn_.geometry());
  PointSet over_drawn;
  std::ranges::copy_if(points_base, std::back_inserter(over_drawn), [&](const Eigen::Vector2d& p) {
    const Cell cell = frame.cell_at(local_T_base * p);
    return drawn_.values().contains(cell) && drawn_.values()[cell] != 0;
  });
  return over_drawn;
}

bool LocalMap::has_moved_since_drawn() const {
  return distance(local_T_drawn_, local_T_base_) >= options_.keyframe_distance_m ||
         std::abs(angle_between(local_T_drawn_.yaw, local_T_base_.yaw)) >= options_.keyframe_angle_rad;
}

void LocalMap::draw(const std::vector<BeamReturn>& returns_base, const PointSet& points_base) {
  drawn_.draw(returns_base, local_T_base_);
  const PointSet points_local = transformed(local_T_base_, points_base);
  points_local_.insert(points_local_.end(), points_local.begin(), points_local.end());
  points_local_ = thinned(points_local_, options_.spacing_m);
  field_ = LikelihoodField(occupancy(), options_.likelihood);
  local_T_drawn_ = local_T_base_;
  // The walls just drawn lie where this pose put them. Were the uncertainty kept, along a bare corridor it
  // would grow until chance likenesses of the walls outweigh the odometry.
  covariance_.setZero();
}

PointSet LocalMap::points_in_local() const {
  const GridFrame frame(drawn_.geometry());
  PointSet standing;
  std::ranges::copy_if(points_local_, std::back_inserter(standing), [&](const Eigen::Vector2d& p) {
    const Cell cell = frame.cell_at(p);
    return drawn_.values().contains(cell) && drawn_.values()[cell] > 0;
  });
  return standing;
}

PointSet LocalMap::points_in_base() const { return transformed(inverse(local_T_base_), points_in_local()); }

OccupancyGrid LocalMap::occupancy() const {
  // Any belief counts: a local map of a few scans cannot wait for certainty.
  return drawn_.occupancy(0.5, 0.5);
}

}  // namespace mstsl
