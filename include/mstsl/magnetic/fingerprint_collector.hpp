#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mstsl/core/sensor_data.hpp"
#include "mstsl/magnetic/fingerprint.hpp"

namespace mstsl {

struct CollectorOptions {
  /// Travel of the magnetometer per fingerprint, in m (paper section III-A.2: 5 cm).
  double spacing_m = 0.05;
  /// Turn after which a fingerprint ends even without travel, in rad, so that it has one heading.
  double turn_rad = 0.35;
  /// Poses further apart in time than this, in s, are not interpolated between.
  double max_pose_gap_s = 0.5;
  /// A pose that would need more than this speed, in m/s, is a jump: no robot of this kind drives it.
  double max_speed_m_s = 5.0;
};

/// What became of the readings. Every reading is counted once: used, or dropped for one of the reasons.
struct CollectionReport {
  std::uint64_t readings = 0;
  std::uint64_t used = 0;
  std::uint64_t not_finite = 0;    ///< NaN or infinite field
  std::uint64_t out_of_order = 0;  ///< stamped before a reading that was already used
  std::uint64_t without_pose = 0;  ///< before the first or after the last pose of its log
  std::uint64_t in_pose_gap = 0;   ///< between poses too far apart in time
  std::uint64_t at_pose_jump = 0;  ///< between poses too far apart in space
  std::uint64_t bad_poses = 0;     ///< poses that were not finite or came out of order (poses, not readings)
};

/// Turns a survey's poses and field readings, fed in time order, into fingerprints. The mounting is applied
/// in full: a fingerprint lies where the magnetometer was, not the base, and its field is turned by the
/// sensor's own 3-D rotation and the robot's yaw. Each fingerprint is the mean of the readings within one
/// `spacing_m` of travel (the straight distance from its first reading), so standing still is one fingerprint
/// however long it lasts.
class FingerprintCollector {
 public:
  explicit FingerprintCollector(const Rig& rig, const CollectorOptions& options = {});

  void observe(const PoseReading& pose);
  void observe(const FieldReading& reading);
  /// The next readings belong to another log, with another rig perhaps: nothing is joined across.
  void start_session(const Rig& rig);

  /// Closes the last fingerprint and hands over all of them, in the order of the drive.
  std::vector<Fingerprint> finish();
  const CollectionReport& report() const { return report_; }

 private:
  struct Sample {
    Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
    Eigen::Vector3d field_uT = Eigen::Vector3d::Zero();
    double heading_rad = 0.0;
  };
  /// The fingerprint being made: where it began, and the sums of its readings.
  struct Open {
    Sample first;
    Sample sum;  ///< its heading is the turn from the first reading's
    double count = 0.0;
    double carried_m = 0.0;  ///< how far behind the first reading its 5 cm began
  };
  void join(const PoseReading& from, const PoseReading& to);
  void add(const Sample& sample);
  void close_fingerprint();
  void interrupt(std::uint64_t& counter);

  Rig rig_;
  CollectorOptions options_;
  CollectionReport report_;
  int session_ = 0;
  std::optional<PoseReading> last_pose_;
  std::optional<Stamp> last_reading_;
  std::vector<FieldReading> waiting_;  ///< newer than the last pose, at most `max_pose_gap_s` of them
  std::optional<Open> open_;
  std::vector<Fingerprint> fingerprints_;
};

}  // namespace mstsl
