#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include <Eigen/Core>

#include "mstsl/core/random.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/scan/line_fit.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl {

struct AlignOptions {
  LineFitOptions line;
  /// The robot has driven off once it is this far, in m, from where it stood at the first scan: more than the
  /// base of a differential drive moves when it turns in place.
  double drive_off_m = 0.05;
  /// A robot that neither drives off nor turns for this long, in s, is not waited for any more; longer than
  /// the second that a robot takes to begin a commanded turn.
  double patience_s = 3.0;
  /// Readings within this distance (m) and turn (rad) of each other were taken in one place: small against
  /// the 0.4 m over which fields change, and against the 1.2 deg to which a robot is aligned (paper, Table
  /// I).
  double still_m = 0.02;
  double still_rad = 0.01;
  /// Standing for less than this, in s, is not standing.
  double min_stay_s = 0.3;
  /// Readings older than this, in s, are forgotten: longer than a turn by 90 deg with a second before and
  /// after.
  double memory_s = 8.0;
};

/// A line found in a scan, and where the base was then, by odometry.
struct SeenLine {
  Pose2 track_T_base;
  double beta_rad = 0.0;  ///< the turn that makes the robot parallel to the line
};

/// The magnetic field of one place in the aligned frame D, whose x axis is parallel (or square) to the
/// building.
struct AlignedReading {
  Stamp stamp;                   ///< of the last reading taken there
  Pose2 track_T_base;            ///< where the base was, by odometry
  double aligned_yaw_rad = 0.0;  ///< of the base in D: what is left of beta after the robot turned, negative
  Eigen::Vector3d field_uT = Eigen::Vector3d::Zero();  ///< in D
  std::size_t readings = 0;                            ///< that it is the mean of
  double beta_rad = 0.0;                               ///< the paper's beta, of the first line seen
};

/// Waits for the first field reading worth matching (paper section III-A.3): finds a line in the first scan,
/// lets the robot turn by beta if it does so, and takes the mean of the readings while it stands. What is
/// left of beta is made up for by turning the measured vector about z, which equals turning the robot when
/// the sensor is calibrated; so a robot that obeys and a log that cannot be commanded are one case.
class FirstReading {
 public:
  explicit FirstReading(const AlignOptions& options) : options_(options) {}

  /// A scan's points in the base frame, and the base by odometry at its stamp.
  void observe_scan(Stamp stamp, const PointSet& points_base_m, const Pose2& track_T_base, Random& random);
  /// A reading, turned into the base frame.
  void observe_field(Stamp stamp, const Eigen::Vector3d& base_field_uT, const Pose2& track_T_base);

  /// The aligned reading, once there is nothing better to wait for: the robot drives off, or has stood for
  /// long enough. Nothing while a line or a field reading is missing.
  std::optional<AlignedReading> take() const;

  bool has_line() const { return !lines_.empty(); }
  bool has_field() const { return !samples_.empty(); }

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
    std::size_t size() const { return end - first; }
  };

  void note_motion(Stamp stamp, const Pose2& track_T_base);
  bool in_one_place(const Pose2& a, const Pose2& b) const;
  bool done_waiting() const;
  double duration_s(const Stay& stay) const;
  Stay best_stay() const;
  AlignedReading align(const Stay& stay) const;

  AlignOptions options_;
  std::deque<SeenLine> lines_;
  std::deque<Sample> samples_;
  std::optional<double> beta_rad_;
  std::optional<Pose2> track_T_start_;
  std::optional<Pose2> track_T_last_scan_;
  TimedPose rest_;  ///< where, and since when, the robot has not moved
  Stamp now_;
  bool driven_off_ = false;
};

}  // namespace mstsl
