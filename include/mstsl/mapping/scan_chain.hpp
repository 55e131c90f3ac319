#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/localize/joint/station_collector.hpp"
#include "mstsl/localize/motion_noise.hpp"
#include "mstsl/mapping/keyframe.hpp"
#include "mstsl/mapping/recent_walls.hpp"
#include "mstsl/mapping/scan_queue.hpp"
#include "mstsl/mapping/wheels.hpp"
#include "mstsl/scan/fit_around.hpp"
#include "mstsl/scan/scanned_walls.hpp"

namespace mstsl {

struct ScanChainOptions {
  /// A scan becomes a keyframe after so much motion (m, rad): what a scan sees changes little in between, and
  /// the wheels bridge it to a centimetre.
  double keyframe_m = 0.25;
  double keyframe_rad = radians(9.0);
  /// ... and is matched after this share of it: the less wheels have to bridge, the better.
  double matched_share = 0.3;
  /// ... and after this time (s) whatever the wheels say.
  double matched_s = 0.4;
  /// Where wheels said nothing for so long (s), a scan that scores less than `lost_below` is looked for as
  /// far as a robot may have gone meanwhile; a break of odometry counts as so long a silence.
  double silence_s = 1.0;
  double break_s = 4.0;
  double lost_below = 0.5;
  double speed_m_s = 0.5;
  double turn_rad_s = 1.0;
  /// Scans are matched to the walls seen in the last so many metres.
  double recent_m = 12.0;
  double spacing_m = 0.1;  ///< of the points kept
  std::size_t max_points = 250;
  /// Returns from farther away (m) are not used: a turn by half a degree moves them by more than they tell.
  double max_range_m = 20.0;
  /// Wheels may be off by so many times their usual error; a match that takes this for granted must score so
  /// much more than one that does not.
  double slipped = 6.0;
  double slip_gain = 0.03;
  /// A scan that scores less looks around for a better pose, which must score so much more.
  double search_below = 0.7;
  double search_gain = 0.1;
  /// A scan with fewer of its points on the walls seen so far says nothing of the motion.
  double least_score = 0.3;
  /// Each point counts: a scan and the walls drawn a moment ago share few errors.
  FitOptions fit = {.sigma_m = 0.06, .points_per_error = 1.0, .max_iterations = 10};
  ScannedWallsOptions walls;
  MotionNoise odometry;
  joint::StationOptions stations;
};

/// The first half of mapping: makes of a drive's scans, wheels and field a chain of keyframes, each placed by
/// matching its scan to the walls of the last metres. Feed it in time order.
class ScanChain {
 public:
  explicit ScanChain(const Rig& rig, const ScanChainOptions& options = {});

  void observe(const OdometryReading& odometry);
  void observe(const OdometryRestart& restart) { queue_.observe(restart); }
  void observe(const LaserScan& scan);
  void observe(const FieldReading& field);
  void finish() { take_waiting(true); }

  /// What has been learned of the wheels; used from here on.
  void set_wheels(const WheelCalibration& wheels) { wheels_ = wheels; }

  /// The keyframes since the last call.
  std::vector<Keyframe> take();

  /// Every scan that was matched so far, and where on the chain it was taken.
  const std::vector<TimedPose>& matched_scans() const { return matched_scans_; }
  /// track_T_base so far, as ThinnedTrack keeps it.
  const std::vector<TimedPose>& odometry() const { return queue_.odometry(); }
  std::size_t scans() const { return queue_.scans_seen(); }
  std::size_t breaks() const { return queue_.track().breaks(); }
  double travelled_m() const { return queue_.track().travelled_m(); }

 private:
  void take_waiting(bool now);
  void take_fields(Stamp until);
  bool moved(const Pose2& from, const Pose2& to, double share) const;
  bool is_due(Stamp stamp, const Pose2& track_T_base) const;
  void add(const PlacedScan& placed);
  void place(Keyframe& keyframe, double silent_s) const;
  WallFit matched(const PointSet& points, const PosePrior& prior) const;
  WallFit found_again(const PointSet& points, const Pose2& about, double silent_s) const;
  double longest_silence_s(Stamp stamp) const;

  Rig rig_;
  ScanChainOptions options_;
  WheelCalibration wheels_;
  ScanQueue queue_;
  std::vector<TimedPose> matched_scans_;  ///< chain_T_base
  std::deque<FieldReading> waiting_fields_;
  joint::StationCollector stations_;
  RecentWalls walls_;
  /// The last scan that was matched.
  struct At {
    Stamp stamp;
    Pose2 track_T_base, chain_T_base;
  };
  std::optional<At> at_;
  bool broken_since_keyframe_ = false;
  std::optional<At> last_keyframe_;
  std::vector<Keyframe> made_;
  std::uint64_t breaks_at_last_ = 0;
};

}  // namespace mstsl
