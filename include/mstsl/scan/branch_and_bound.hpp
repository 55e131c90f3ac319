#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/grid/geometry.hpp"
#include "mstsl/scan/likelihood_pyramid.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl {

/// The poses to search: a box around `center`, its sides along the axes of the map's *grid*.
struct SearchWindow {
  Pose2 center;                                       ///< map_T_base
  Eigen::Vector2d reach_m = Eigen::Vector2d::Zero();  ///< to each side, along the grid's x and y
  double reach_rad = 0.0;                             ///< to each side; pi or more: every heading

  /// The box around the ellipsoid of so many standard deviations (the paper's 3 sigma) of a pose with the
  /// covariance of (x, y, yaw) in the map frame.
  static SearchWindow around(const Pose2& map_T_base, const Eigen::Matrix3d& covariance, double sigmas,
                             const GridGeometry& geometry);
  /// Every pose on the map.
  static SearchWindow whole(const GridGeometry& geometry);
};

struct PoseSearchOptions {
  /// Poses that score less are not looked for (0 .. 1).
  double min_score = 0.3;
  /// Answers closer together than this in both place and heading are one: only the best is given.
  double distinct_m = 0.5;
  double distinct_rad = 0.17;
  /// How many distinct answers at most.
  std::size_t max_answers = 1;
  /// Heading step (rad); 0: the largest that moves the farthest point by no more than a cell (Hess et al.,
  /// Eq. 7).
  double yaw_step_rad = 0.0;
};

struct ScoredPose {
  Pose2 map_T_base;
  double score = 0.0;  ///< mean likelihood of the points, 0 .. 1
};

/// The best poses on the lattice of whole cells and heading steps in the window, best first: exactly what
/// trying every one (with the same 8-bit field), sorting, and dropping those too near a better one would
/// give, by best-first branch and bound (Olson 2009; Hess et al. 2016, Sec. V). Empty when nothing reaches
/// min_score or there are no points.
std::vector<ScoredPose> search_poses(const LikelihoodPyramid& map, const PointSet& points_base_m,
                                     const SearchWindow& window, const PoseSearchOptions& options = {});

}  // namespace mstsl
