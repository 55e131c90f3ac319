#pragma once

#include <Eigen/Core>

namespace mstsl {

/// What a scan matcher wants to know of the nearest wall at a place.
struct WallSample {
  double squared_m2 = 0.0;        ///< squared distance, at most the walls' reach squared
  Eigen::Vector2d slope_m{0, 0};  ///< of squared_m2 / 2 by the place, map frame: the vector from the wall
  /// Mean of n n^T over the wall's normals n near here (xx, xy, yy; map frame, trace 1): one direction for a
  /// wall, both for a corner or a pillar. Zero where no wall is in reach.
  Eigen::Vector3d facing{0, 0, 0};
};

}  // namespace mstsl
