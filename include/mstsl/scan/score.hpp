#pragma once

#include <limits>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl {

/// Hypotheses that score less are false (the paper's empirical threshold, after Eq. 5).
inline constexpr double kConfidenceThreshold = 0.85;

struct ScoreOptions {
  /// A point this near an occupied cell's square hits it (m). Three standard deviations of a UTM-30LX's range
  /// noise are 3 cm, a refined pose and a real map's walls are off by some cm each. In real buildings
  /// (Freiburg and Seattle logs) 7.5 cm puts the paper's threshold between the worst 5 % of right poses
  /// (0.89, 0.92) and the best 5 % of wrong ones (0.68, 0.76).
  double hit_tolerance_m = 0.075;
  /// Points farther from the base than this are left out: a small error of heading moves them off their wall.
  double max_range_m = std::numeric_limits<double>::infinity();
  /// The paper counts every point that hits no wall against the pose. Without this, a point that the laser
  /// saw through an opening into what the map does not know is not asked: maps end at doors that were shut
  /// when they were made. A point behind a mapped wall counts in any case.
  bool unmapped_is_miss = true;
  /// ... but S is taken over at least this share of the points: a pose at the map's edge that leaves most of
  /// the scan unexplained is not confirmed by the few points that are left.
  double least_judged_share = 0.5;
};

/// The paper's confidence score S = (sum over j of P_j) / J: the share of the scan's points that hit an
/// occupied cell of the map when the robot stands at `map_T_base`. 0 for a scan without points.
double confidence_score(const OccupancyGrid& map, const PointSet& points_base_m, const Pose2& map_T_base,
                        const ScoreOptions& options = {});

}  // namespace mstsl
