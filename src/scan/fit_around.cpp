#include "mstsl/scan/fit_around.hpp"

#include <cmath>
#include <optional>

namespace mstsl {

Eigen::Matrix3d Surroundings::spread() const {
  const Eigen::Vector3d half(step_m / 2, step_m / 2, turn_rad / 2);
  return half.cwiseAbs2().asDiagonal();
}

namespace {

template <typename Walls>
WallFit best_around(const Walls& walls, const PointSet& points_base_m, const Pose2& map_T_base,
                    const Surroundings& around, const FitOptions& options) {
  const Eigen::Matrix3d spread = around.spread();
  std::optional<WallFit> best;
  for (int turn = -around.turns; turn <= around.turns; ++turn)
    for (int i = -around.steps; i <= around.steps; ++i)
      for (int j = -around.steps; j <= around.steps; ++j) {
        if (!around.corners && i != 0 && j != 0) continue;
        const Pose2 from = map_T_base * Pose2{i * around.step_m, j * around.step_m, turn * around.turn_rad};
        const WallFit fit = fit_to_walls(walls, points_base_m, {from, spread}, options);
        if (!best || fit.score > best->score) best = fit;
      }
  return *best;
}

}  // namespace

WallFit fit_around(const WallField& walls, const PointSet& points_base_m, const Pose2& map_T_base,
                   const Surroundings& around, const FitOptions& options) {
  return best_around(walls, points_base_m, map_T_base, around, options);
}

WallFit fit_around(const ScannedWalls& walls, const PointSet& points_base_m, const Pose2& map_T_base,
                   const Surroundings& around, const FitOptions& options) {
  return best_around(walls, points_base_m, map_T_base, around, options);
}

}  // namespace mstsl
