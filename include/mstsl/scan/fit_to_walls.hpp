#pragma once

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/scan/points.hpp"
#include "mstsl/scan/refine.hpp"
#include "mstsl/scan/scanned_walls.hpp"
#include "mstsl/scan/wall_field.hpp"

namespace mstsl {

struct FitOptions {
  /// Standard deviation of a scan point's distance from its wall (m), as in LikelihoodOptions.
  double sigma_m = 0.10;
  /// As in RefineOptions: only every n-th point brings independent evidence.
  double points_per_error = 4.0;
  int max_iterations = 5;
  /// The first steps see walls from farther off, up to this many sigma: as far as the prior says that the
  /// points may lie from theirs.
  double widest = 4.0;
  /// A step shorter than this (m, or rad at 1 m) ends the iteration: a tenth of what a cell can tell.
  double converged_m = 0.002;
};

/// A pose fitted to the walls, and how well it fits there.
struct WallFit {
  Pose2 map_T_base;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the scan alone, on (x, y, yaw) in the map
  double score = 0.0;  ///< mean over the points of exp(-d^2 / (2 sigma^2)), 0 .. 1
};

/// The pose near the prior's mean that fits the points to the walls best, by a few Gauss-Newton steps on a
/// Welsch loss: a hundredth of refine_pose()'s cost and nearly its answer, for thousands of hypotheses. Walls
/// are taken as lines (each point is free to slide along its wall). Without points: the prior and a score of
/// 0. Expects a positive definite prior covariance.
WallFit fit_to_walls(const WallField& walls, const PointSet& points_base_m, const PosePrior& prior,
                     const FitOptions& options = {});
WallFit fit_to_walls(const ScannedWalls& walls, const PointSet& points_base_m, const PosePrior& prior,
                     const FitOptions& options = {});

/// The score of the points at a pose, as in WallFit.
double wall_score(const WallField& walls, const PointSet& points_base_m, const Pose2& map_T_base,
                  double sigma_m);
double wall_score(const ScannedWalls& walls, const PointSet& points_base_m, const Pose2& map_T_base,
                  double sigma_m);

/// The same, but points of which the map cannot tell, because the laser saw them at or beyond the map's edge
/// (ends_beyond, within `sigma_m`), score at least `unmapped`.
double mapped_score(const OccupancyGrid& occupancy, const WallField& walls, const PointSet& points_base_m,
                    const Pose2& map_T_base, double sigma_m, double unmapped);

}  // namespace mstsl
