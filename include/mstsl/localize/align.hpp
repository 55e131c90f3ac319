#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <optional>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/core/stamp.hpp"
#include "mstsl/scan/line_fit.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl {

struct AlignOptions {
  LineFitOptions line;
  /// The robot has driven off once it is this far, in m, from where it stood at the first scan: more than the base of a
  /// differential drive moves when it turns in place.
  double drive_off_m = 0.05;
  /// A robot that neither drives off nor turns for this long, in s, is not waited for any more; longer than the second
  /// that a robot takes to begin a commanded turn.
  double patience_s = 3.0;
  /// Readings within this distance and turn of each other were taken in one place. Small against the 0.4 m over which
  /// fields change and the 1.2 deg to which the robot is aligned (paper, Table I).
  double still_m = 0.02;
  double still_rad = 0.01;
  /// Standing readings over less than this, in s, are no better than moving ones.
  double min_standing_s = 0.3;
  /// Readings older than this, in s, are of no use for a start from the present place.
  double memory_s = 8.0;
};

/// A line found in a scan, and where the base was then (frame of the odometry).
struct SeenLine {
  Pose2 track_T_base;
  double beta_rad = 0.0;        ///< the turn that makes the robot parallel to the line
  double beta_sigma_rad = 0.0;
};

/// One place's magnetic field in the aligned frame D, whose x axis is parallel (or square) to the building.
struct AlignedReading {
  Stamp stamp;
  Pose2 track_T_base;          ///< where the readings were taken
  double aligned_yaw_base_rad = 0.0;  ///< yaw of the base in D: minus what is left of beta after the robot turned
  Eigen::Vector3d field_uT = Eigen::Vector3d::Zero();  ///< in D
  std::size_t readings = 0;    ///< that this is the mean of
  double beta_rad = 0.0;       ///< the paper's beta: of the first line seen
};

/// Waits for the first field reading worth matching (paper section III-A.3): looks for a line in the first scan, lets
/// the robot turn by beta if it does so, and takes the mean of the readings while it stands. What is left of beta is
/// made up for by turning the measured vector about z, which equals turning the robot when the sensor is calibrated;
/// so a robot that obeys and a log that cannot be commanded are one case.
class FirstReading {
 public:
  explicit FirstReading(const AlignOptions& options) : options_(options) {}

  /// A scan's points in the base frame, and the base by odometry at its stamp.
  void observe_scan(Stamp stamp, const PointSet& points_base_m, const Pose2& track_T_base, Random& random);
  /// A reading turned into the base frame.
  void observe_field(Stamp stamp, const Eigen::Vector3d& base_field_uT, const Pose2& track_T_base);

  /// The aligned reading, once there is nothing better to wait for: the robot drives off, or has stood long enough.
  std::optional<AlignedReading> take() const;

  bool has_line() const { return !lines_.empty(); }
  bool has_field() const { return !samples_.empty(); }
  /// beta of the first line seen.
  std::optional<double> beta_rad() const { return beta_rad_; }

 private:
  struct Sample {
    Stamp stamp;
    Pose2 track_T_base;
    Eigen::Vector3d base_field_uT;
  };
  /// Successive samples taken in one place: [first, end).
  struct Stay {
    std::size_t first = 0;
    std::size_t end = 0;
  };
  bool ready() const;
  bool together(const Pose2& a, const Pose2& b) const;
  Stay best_stay() const;
  const SeenLine& line_nearest(const Pose2& track_T_base) const;

  AlignOptions options_;
  std::deque<SeenLine> lines_;
  std::deque<Sample> samples_;
  std::optional<double> beta_rad_;
  std::optional<TimedPoseAtStart> start_;
};

}  // namespace mstsl
