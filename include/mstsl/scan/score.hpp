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
  /// A point this near an occupied cell's square hits it (m): one 5 cm cell, that is the cell itself and its
  /// neighbours. Three standard deviations of a UTM-30LX's range noise are 3 cm, a refined pose adds about 2
  /// cm.
  double hit_tolerance_m = 0.05;
  /// Points farther from the base than this are left out: a small error of heading moves them off their wall.
  double max_range_m = std::numeric_limits<double>::infinity();
};

/// The paper's confidence score S = (sum over j of P_j) / J: the share of the scan's points that hit an
/// occupied cell of the map when the robot stands at `map_T_base`. 0 for a scan without points.
double confidence_score(const OccupancyGrid& map, const PointSet& points_base_m, const Pose2& map_T_base,
                        const ScoreOptions& options = {});

}  // namespace mstsl
