#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/scan/branch_and_bound.hpp"
#include "mstsl/scan/likelihood_field.hpp"
#include "mstsl/scan/points.hpp"
#include "mstsl/scan/refine.hpp"
#include "mstsl/scan/score.hpp"

namespace mstsl {

/// The global map made ready for matching: made once, then only read, by as many threads and hypotheses as
/// like.
struct MatchMap {
  explicit MatchMap(OccupancyGrid map, const LikelihoodOptions& options = {}, int pyramid_levels = 7);

  OccupancyGrid occupancy;
  LikelihoodField field;
  LikelihoodPyramid pyramid;
};

struct SubmapMatchOptions {
  double window_sigmas = 3.0;  ///< the paper's search within 3 sigma of the hypothesis
  /// No more of the local map's points than this are matched, spread over all of it.
  std::size_t max_points = 400;
  PoseSearchOptions search = {};
  RefineOptions refine = {};
  ScoreOptions score = {};
};

struct SubmapMatch {
  Refinement refined;         ///< pose, covariance, convergence
  double search_score = 0.0;  ///< of the best lattice pose: mean likelihood, 0 .. 1
  double confidence = 0.0;    ///< the paper's S of the scan at the refined pose
};

/// The paper's observation model for one hypothesis (Sec. III-B): the local map `local_points_base_m`
/// (LocalMap:: points_in_base) is searched for within 3 sigma of the prior, by branch and bound, refined by
/// least squares, and the current scan `scan_points_base_m` scored at the refined pose. Nothing when no pose
/// in the window reaches the search's min_score: the hypothesis has no support.
std::optional<SubmapMatch> match_submap(const MatchMap& map, const PointSet& local_points_base_m,
                                        const PointSet& scan_points_base_m, const PosePrior& prior,
                                        const SubmapMatchOptions& options = {});

}  // namespace mstsl
