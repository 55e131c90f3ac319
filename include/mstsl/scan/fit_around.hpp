#pragma once

#include "mstsl/scan/fit_to_walls.hpp"

namespace mstsl {

/// How far around a pose to look for a better one, in steps that fits reach across: a fit finds a wall from
/// 0.2 m and a turn from 3 deg.
struct Surroundings {
  int steps = 1;  ///< to each side, along the base's axes
  double step_m = 0.25;
  bool corners = false;  ///< the whole square, or the cross only
  int turns = 4;         ///< to each side
  double turn_rad = 0.06;

  /// Standard deviations with which each fit begins: half a step.
  Eigen::Matrix3d spread() const;
};

/// The best of the fits that begin around a pose.
WallFit fit_around(const WallField& walls, const PointSet& points_base_m, const Pose2& map_T_base,
                   const Surroundings& surroundings, const FitOptions& options = {});
WallFit fit_around(const ScannedWalls& walls, const PointSet& points_base_m, const Pose2& map_T_base,
                   const Surroundings& surroundings, const FitOptions& options = {});

}  // namespace mstsl
