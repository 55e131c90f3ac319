#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/mapping/loop_closer.hpp"
#include "mstsl/mapping/submap.hpp"
#include "mstsl/scan/fit_to_walls.hpp"

namespace mstsl {

/// A place in a submap where the last metres' scans fit.
struct LoopMatch {
  Pose2 origin_T_base;
  Eigen::Matrix3d covariance;  ///< axes of the origin
  double score = 0.0;
  double log_prior = 0.0;  ///< how far it is from where the graph has it
  double log_field = 0.0;

  /// Evidence for it, as log probability.
  double log_weight(const LoopCloserOptions& options) const {
    return log_prior + options.points * (score - options.even_score) + log_field;
  }
};

/// What two rigid pieces of a drive can say of each other at best: 3 cm and a third of a degree.
Eigen::Matrix3d least_covariance();

/// Every place within what the graph leaves possible.
std::vector<LoopMatch> loop_matches(const SubmapWalls& walls, const Stretch& stretch, const PosePrior& prior,
                                    const LoopCloserOptions& options);

/// Adds to each match those along the direction that its scans leave open, as in a bare corridor: the field
/// may tell which it is.
void add_along_what_scans_leave_open(const SubmapWalls& walls, const Stretch& stretch, const PosePrior& prior,
                                     std::vector<LoopMatch>& matches);

/// Which match is the right one, if any is.
struct LoopChoice {
  std::size_t best = 0;
  double probability = 0.0;  ///< against all that are elsewhere, and against none
};
LoopChoice choose(const std::vector<LoopMatch>& among, const LoopCloserOptions& options);

/// What the matches that say the same as the best one say together.
struct LoopPose {
  Pose2 origin_T_base;
  Eigen::Matrix3d covariance;
};
LoopPose pose_of(const std::vector<LoopMatch>& among, std::size_t best, const LoopCloserOptions& options);

}  // namespace mstsl
