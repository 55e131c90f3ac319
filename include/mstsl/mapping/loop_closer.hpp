#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/mapping/field_evidence.hpp"
#include "mstsl/mapping/keyframe.hpp"
#include "mstsl/mapping/pose_graph.hpp"
#include "mstsl/mapping/submap_store.hpp"

namespace mstsl {

struct LoopCloserOptions {
  SubmapOptions submaps;
  double look_every_m = 1.0;  ///< how often older submaps are looked at
  /// Submaps that ended less than this way ago are no loop (m).
  double least_way_m = 15.0;
  /// Submaps farther away than this (m), and the standard deviation of how far, show nothing in common.
  double nearest_m = 4.0;
  double widest_m = 12.0;           ///< no wider window than this to each side is searched ...
  double widest_rad = radians(30);  ///< ... and no more turned one
  double sigmas = 3.0;              ///< of the window
  double min_score = 0.45;          ///< of a match, to be looked at
  /// Evidence in a stretch's scan points: what the share of matched points gains counts so many times, as
  /// log probability, from the score on at which a match is as likely one as not.
  double points = 30.0;
  double even_score = 0.55;
  double accepted_from = 0.99;  ///< probability of being the right one, against all others and none
  bool use_field = true;
  FieldEvidenceOptions field;
};

/// What became of the loops looked at.
struct LoopCounts {
  std::size_t looked_at = 0;  ///< submaps matched
  std::size_t accepted = 0;
  std::size_t ambiguous = 0;         ///< more than one way to close
  std::size_t refused_by_field = 0;  ///< the scans alone would have closed it
  std::size_t earlier_by_field = 0;  ///< the scans alone would not have closed it
};

/// Finds where a drive comes back to where it was: the last metres are matched to older submaps within what
/// the graph leaves possible; scans and field together say which of the matches, if any, is right.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopCloserOptions& options = {}) : options_(options), store_(options.submaps) {}

  /// What follows is another drive, by another robot perhaps: nothing is joined across.
  void begin_drive(const Eigen::Vector2d& magnetometer_base_m) { store_.begin_drive(magnetometer_base_m); }
  /// The next keyframe, of which the graph already has the pose.
  void add(const Keyframe& keyframe) { store_.add(keyframe); }
  /// Closures of the last keyframe, if it is time to look.
  std::vector<Closure> look(const PoseGraph& graph);

  const LoopCounts& counts() const { return counts_; }
  const FieldVariogram& variogram() const { return store_.variogram(); }
  std::size_t keyframes_kept() const { return store_.keyframes_kept(); }

 private:
  /// A submap that may show what the last metres do.
  struct Nearby {
    std::size_t submap = 0;
    double distance_m = 0.0;  ///< of the last keyframe from its way, as far as the graph knows
    /// Of the way between them (PoseGraph::covariances_from_last).
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    double sd_m() const { return std::sqrt(covariance.topLeftCorner<2, 2>().trace()); }
  };
  /// The likeliest first.
  std::vector<Nearby> near(const PoseGraph& graph) const;
  std::optional<Closure> close(std::size_t submap, const Stretch& stretch, const PosePrior& prior);

  LoopCloserOptions options_;
  SubmapStore store_;
  double looked_at_m_ = 0.0;
  LoopCounts counts_;
};

}  // namespace mstsl
