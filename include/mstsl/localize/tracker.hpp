#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>

#include "mstsl/localize/localization_maps.hpp"
#include "mstsl/localize/motion.hpp"
#include "mstsl/scan/points.hpp"
#include "mstsl/scan/refine.hpp"

namespace mstsl {

struct TrackerOptions {
  OdometryNoise odometry;
  /// Added at each scan, as standard deviations: the errors of the map's cells and of the scan's timing.
  double sigma_floor_m = 0.01;
  double sigma_floor_rad = 0.003;
  /// Scan points this near each other count once, m, and no more than so many of them.
  double spacing_m = 0.10;
  std::size_t max_points = 250;
  RefineOptions refine;
  ScoreOptions score{.unmapped_is_miss = false};
  /// A scan that scores less speaks against the pose. Lower than the paper's 0.85, which picks a pose:
  /// people, moved cars and open doors cost a right pose that much for a while. Not much lower: in a wrong
  /// corridor as wide as the right one the two walls alone score 0.6.
  double low_score = 0.75;
  /// After so many low scans in a row the surroundings are searched again ...
  int low_scans_to_search = 5;
  SubmapMatchOptions search{.score = {.unmapped_is_miss = false}};
  /// ... and what is found there is taken if it scores as an answer must (the paper's S): nearly everywhere
  /// something fits a little better than a wrong pose.
  double min_found_score = kConfidenceThreshold;
  double search_sigma_m = 0.35;
  double search_sigma_rad = 0.1;
  /// ... and after so many the robot is lost, unless another witness speaks for the pose: 1.5 m of driving,
  /// or 7 s of standing, at the rates of TwoStepOptions.
  int low_scans_to_lose = 15;
  /// Lost, too, when the position's standard deviation exceeds this, in m: as much as a right pose may be
  /// off.
  double max_sigma_m = 0.5;
};

/// Keeps a known pose known (section III-B continued): odometry's prediction, refined by each scan.
class Tracker {
 public:
  Tracker(std::shared_ptr<const LocalizationMaps> maps, const Pose2& map_T_base,
          const Eigen::Matrix3d& covariance, const TrackerOptions& options);

  /// A scan's points in the base frame, and the base's motion since the last scan by odometry; `broken` if
  /// odometry was interrupted in between, so that the motion is not to be trusted. Without points only
  /// odometry counts.
  void observe(const PointSet& points_base_m, const Pose2& last_T_base, bool broken);

  /// Lost: low scores for too long while no other witness speaks for the pose, or too little known of it.
  bool lost(bool other_witness_agrees = false) const;
  const Pose2& map_T_base() const { return map_T_base_; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }
  double score() const { return score_; }

 private:
  void refine(const PointSet& points_base_m);
  void search(const PointSet& points_base_m);

  std::shared_ptr<const LocalizationMaps> maps_;
  TrackerOptions options_;
  Pose2 map_T_base_;
  Eigen::Matrix3d covariance_;
  double score_ = 1.0;
  int low_scans_ = 0;
};

}  // namespace mstsl
