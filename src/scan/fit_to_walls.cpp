#include "mstsl/scan/fit_to_walls.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "mstsl/core/angles.hpp"
#include "mstsl/grid/ray.hpp"

namespace mstsl {
namespace {

constexpr double kLongest_m = 0.2, kLongest_rad = 0.1;  // a step within the reach of a wall

/// One point's part: its weight under the Welsch loss and its slope and curvature by the pose.
struct Sums {
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();
  double weight = 0.0;
};

template <typename Walls>
Sums sums_at(const Walls& walls, const PointSet& points, const Pose2& pose, double sigma_m) {
  const Eigen::Matrix2d rotation = pose.rotation();
  const double per_square = 1.0 / (sigma_m * sigma_m);
  Sums sums;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d arm = rotation * p;
    const WallSample at = walls.sample(arm + pose.position());
    const double weight = std::exp(-0.5 * at.squared_m2 * per_square);
    sums.weight += weight;
    const double w = weight * per_square;
    const Eigen::Vector2d turn(-arm.y(), arm.x());  // how the point moves as the pose turns
    const double xx = w * at.facing.x(), xy = w * at.facing.y(), yy = w * at.facing.z();
    const double tx = xx * turn.x() + xy * turn.y(), ty = xy * turn.x() + yy * turn.y();
    sums.slope += w * Eigen::Vector3d(at.slope_m.x(), at.slope_m.y(), at.slope_m.dot(turn));
    sums.curvature(0, 0) += xx, sums.curvature(0, 1) += xy, sums.curvature(1, 1) += yy;
    sums.curvature(0, 2) += tx, sums.curvature(1, 2) += ty;
    sums.curvature(2, 2) += turn.x() * tx + turn.y() * ty;
  }
  sums.curvature(1, 0) = sums.curvature(0, 1);
  sums.curvature(2, 0) = sums.curvature(0, 2);
  sums.curvature(2, 1) = sums.curvature(1, 2);
  return sums;
}

/// How far off (m) the prior lets a typical point be: its place and, 5 m away, its turn.
double reach_of(const PosePrior& prior) {
  constexpr double kArm_m = 5.0;
  const Eigen::Vector3d variance = prior.covariance.diagonal();
  return std::sqrt(0.5 * (variance.x() + variance.y()) + kArm_m * kArm_m * variance.z());
}

double squared_distance_m2(const WallField& walls, const Eigen::Vector2d& map_point_m) {
  const double d = walls.distances().at(map_point_m);
  return d * d;
}
double squared_distance_m2(const ScannedWalls& walls, const Eigen::Vector2d& map_point_m) {
  return walls.sample(map_point_m).squared_m2;
}

/// Mean over the points, seen from a pose, of what `score` says of their distance to the nearest wall and
/// place.
template <typename Walls, typename Score>
double mean_score(const Walls& walls, const PointSet& points_base_m, const Pose2& map_T_base, double sigma_m,
                  Score score) {
  if (points_base_m.empty()) return 0.0;
  const Eigen::Matrix2d rotation = map_T_base.rotation();
  double sum = 0;
  for (const Eigen::Vector2d& p : points_base_m) {
    const Eigen::Vector2d at_m = rotation * p + map_T_base.position();
    sum += score(std::exp(-0.5 * squared_distance_m2(walls, at_m) / (sigma_m * sigma_m)), at_m);
  }
  return sum / static_cast<double>(points_base_m.size());
}

double plain_score(double score, const Eigen::Vector2d&) { return score; }

template <typename Walls>
WallFit fitted(const Walls& walls, const PointSet& points_base_m, const PosePrior& prior,
               const FitOptions& options) {
  WallFit fit{prior.mean};
  if (points_base_m.empty()) return fit;
  const Eigen::Matrix3d prior_information = prior.covariance.inverse();
  Sums sums;
  double width = std::clamp(reach_of(prior) / options.sigma_m, 1.0, options.widest);
  for (int i = 0; i < options.max_iterations; ++i) {
    sums = sums_at(walls, points_base_m, fit.map_T_base, width * options.sigma_m);
    const Eigen::Vector3d off = difference(prior.mean, fit.map_T_base);
    const Eigen::Vector3d slope = sums.slope / options.points_per_error + prior_information * off;
    const Eigen::Matrix3d curvature = sums.curvature / options.points_per_error + prior_information;
    Eigen::Vector3d step = curvature.inverse() * slope;
    if (!step.allFinite()) break;
    // Far from its answer the curvature says little of how far that is.
    const double too_long = std::max(step.head<2>().norm() / kLongest_m, std::abs(step.z()) / kLongest_rad);
    if (too_long > 1.0) step /= too_long;
    fit.map_T_base = Pose2::from(fit.map_T_base.position() - step.head<2>(), fit.map_T_base.yaw - step.z());
    if (width == 1.0 && step.norm() < options.converged_m) break;
    width = std::max(1.0, 0.6 * width);
  }
  if (width > 1.0) sums = sums_at(walls, points_base_m, fit.map_T_base, options.sigma_m);
  fit.information = sums.curvature / options.points_per_error;
  fit.score = mean_score(walls, points_base_m, fit.map_T_base, options.sigma_m, plain_score);
  return fit;
}

}  // namespace

WallFit fit_to_walls(const WallField& walls, const PointSet& points_base_m, const PosePrior& prior,
                     const FitOptions& options) {
  return fitted(walls, points_base_m, prior, options);
}

WallFit fit_to_walls(const ScannedWalls& walls, const PointSet& points_base_m, const PosePrior& prior,
                     const FitOptions& options) {
  return fitted(walls, points_base_m, prior, options);
}

double wall_score(const WallField& walls, const PointSet& points_base_m, const Pose2& map_T_base,
                  double sigma_m) {
  return mean_score(walls, points_base_m, map_T_base, sigma_m, plain_score);
}

double wall_score(const ScannedWalls& walls, const PointSet& points_base_m, const Pose2& map_T_base,
                  double sigma_m) {
  return mean_score(walls, points_base_m, map_T_base, sigma_m, plain_score);
}

double mapped_score(const OccupancyGrid& occupancy, const WallField& walls, const PointSet& points_base_m,
                    const Pose2& map_T_base, double sigma_m, double unmapped) {
  return mean_score(
      walls, points_base_m, map_T_base, sigma_m, [&](double score, const Eigen::Vector2d& at_m) {
        const bool unknown = score < unmapped && ends_beyond(occupancy, map_T_base.position(), at_m, sigma_m);
        return unknown ? unmapped : score;
      });
}

}  // namespace mstsl
