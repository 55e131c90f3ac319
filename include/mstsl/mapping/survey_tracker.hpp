#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/localize/motion_noise.hpp"
#include "mstsl/mapping/scan_queue.hpp"
#include "mstsl/scan/fit_around.hpp"
#include "mstsl/scan/wall_field.hpp"

namespace mstsl {

struct SurveyTrackerOptions {
  /// How far off the initial pose may be: 1 m and 21 deg, what a hand does to a map on a screen.
  Surroundings at_start{.steps = 4, .step_m = 0.25, .corners = true, .turns = 6, .turn_rad = 0.06};
  /// A scan is matched after so much motion (m, rad) or time (s).
  double match_every_m = 0.05;
  double match_every_rad = radians(3.0);
  double match_every_s = 1.0;
  double spacing_m = 0.1;  ///< of the points matched
  std::size_t max_points = 250;
  /// A scan that scores less (WallFit::score) looks around for a better pose, which must score so much more.
  double search_below = 0.7;
  double search_gain = 0.15;
  /// Scores below this for so long a way (m) mean that the robot is not where it is thought to be.
  double lost_below = 0.45;
  double lost_after_m = 3.0;
  FitOptions fit = {.points_per_error = 5.0};
  MotionNoise odometry;
};

/// Where the robot was on a drive, from all of its scans: often enough (ThinnedTrack) for all times between.
struct SurveyTrack {
  Trajectory map_T_base;
  std::size_t scans = 0;      ///< matched
  double way_m = 0.0;         ///< driven
  double mean_score = 0.0;    ///< of the matched scans, 0 .. 1
  double worst_sd_m = 0.0;    ///< largest standard deviation of a place
  double typical_sd_m = 0.0;  ///< its root mean square over the scans
};

/// Tracks a survey on a known map from a roughly known start: scans are matched to the walls with odometry as
/// the prior (a Kalman filter), and in the end all of them tell of every pose (Rauch, Tung & Striebel 1965).
/// Feed it in time order; answers are given at the end.
class SurveyTracker {
 public:
  SurveyTracker(std::shared_ptr<const WallField> walls, const Rig& rig, const Pose2& initial_map_T_base,
                const SurveyTrackerOptions& options = {});

  void observe(const OdometryReading& odometry);
  void observe(const OdometryRestart& restart) { queue_.observe(restart); }
  void observe(const LaserScan& scan);

  /// Errors: no odometry, no scan, a start where no scan fits, a track that was lost on the way (when).
  Result<SurveyTrack> finish();

 private:
  /// A matched scan: what was believed before and after it.
  struct Node {
    Stamp stamp;
    Pose2 track_T_base;
    Pose2 predicted, map_T_base;
    Eigen::Matrix3d predicted_covariance, covariance, by_last;  ///< by_last: d(predicted) / d(last)
    double score = 0.0;
  };
  void take_waiting(bool now);
  void match(const PlacedScan& placed);
  bool due(Stamp stamp, const Pose2& track_T_base) const;
  void start(const PointSet& points, Stamp stamp, const Pose2& track_T_base);
  void go_on(const PointSet& points, Stamp stamp, const Pose2& track_T_base);
  void watch(const Node& node, double moved_m);
  void smooth();
  SurveyTrack between_scans() const;

  std::shared_ptr<const WallField> walls_;
  Rig rig_;
  Pose2 initial_;
  SurveyTrackerOptions options_;
  ScanQueue queue_;
  std::vector<Node> nodes_;
  std::uint64_t breaks_at_last_ = 0;
  double lost_for_m_ = 0.0;
  std::optional<Error> error_;
};

}  // namespace mstsl
