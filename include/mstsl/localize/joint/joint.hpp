#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "mstsl/localize/joint/maps.hpp"
#include "mstsl/localize/joint/mode_bank.hpp"
#include "mstsl/localize/joint/station_collector.hpp"
#include "mstsl/localize/localizer.hpp"
#include "mstsl/localize/odometry_track.hpp"

namespace mstsl {

struct JointOptions {
  joint::StationOptions stations;
  joint::BankOptions bank;
  OdometryTrackOptions odometry;
  /// A pose is published from this probability on of being right (within 0.5 m and 10 deg).
  double localized_from = 0.999;
  /// ... once it has held for this way (m): what two near places show is nearly the same evidence.
  double agree_m = 1.0;
  /// A published pose is taken back when its probability has been below this for so long a way (m): who
  /// stands before the laser for a moment is gone by then.
  double lost_below = 0.5;
  double lost_after_m = 0.3;
  /// The places that a scan allows are searched for when "none of these" has more than this share ...
  double search_above = 0.3;
  /// ... but not more often than this (m): the new ones need a way to prove themselves.
  double search_every_m = 1.0;
  /// Where the lidar tells nothing, the field is searched for the last metres of the way: at least and at
  /// most so many.
  double field_search_least_m = 2.0;
  double field_search_most_m = 4.0;
  /// A scan is processed after so much motion (m, rad) or time (s) since the last one that was.
  double process_every_m = 0.1;
  double process_every_rad = radians(5.0);
  double process_every_s = 0.5;
  /// Where scans are further apart than this (m), the field alone makes steps in between.
  double step_without_scan_m = 0.15;
  /// Scans with fewer returns say nothing.
  std::size_t min_returns = 30;
};

/// What is wrong with the options, if anything, in one sentence.
std::optional<Error> invalid(const JointOptions& options);

/// The joint method: one posterior over pose, bias and map error, as a sum of Gaussian modes found by LiDAR
/// over the whole free space and weighed by field and LiDAR as the robot drives; silent until one place has
/// nearly all the weight. Any heading, nothing commanded.
class Joint {
 public:
  Joint(std::shared_ptr<const joint::Maps> maps, const Rig& rig, const JointOptions& options = {});

  void observe(const OdometryReading& odometry);
  void observe(const OdometryRestart& restart) { track_.restart(restart); }
  void observe(const LaserScan& scan);
  void observe(const FieldReading& field);
  Estimate estimate() const;
  LocalizerReport report() const;

  const joint::ModeBank& bank() const { return bank_; }

 private:
  struct Counts {
    std::uint64_t late_scans = 0, blind_scans = 0, scans_without_odometry = 0;
    std::uint64_t bad_field = 0, field_without_odometry = 0, stations = 0;
    std::uint64_t searches = 0, cut_searches = 0, field_searches = 0, times_lost = 0;
  };
  /// Readings wait for the odometry around them, but no longer than until the next scan is processed.
  void take_waiting(bool now);
  void watch_for_dark(Stamp now);
  bool worth_processing(Stamp stamp, const Pose2& track_T_base) const;
  joint::Step make_step(Stamp stamp, const Pose2& track_T_base);
  PointSet points_of(const LaserScan& scan, const Pose2& track_T_base);
  void advance(const joint::Step& step, const Pose2& track_T_base);
  void search_if_due(const joint::Step& step, const Pose2& track_T_base);
  bool search_by_scan(const joint::Step& step);
  void search_by_field(const Pose2& track_T_base);
  void remember(const joint::Step& step, const Pose2& track_T_base);
  void judge(const Pose2& last_T_base);
  double probability_near(const Pose2& map_T_base) const;

  std::shared_ptr<const joint::Maps> maps_;
  Rig rig_;
  JointOptions options_;
  OdometryTrack track_;
  joint::StationCollector stations_;
  std::deque<FieldReading> waiting_;
  joint::ModeBank bank_;
  Counts counts_;
  std::optional<Stamp> last_scan_, last_field_;
  double usual_gap_s_ = 0.1;            ///< between readings of any sensor but odometry
  bool after_dark_ = false;             ///< neither scan nor field came for a while
  std::optional<TimedPose> processed_;  ///< the last scan that was worth a step
  std::optional<TimedPose> last_step_;
  std::uint64_t breaks_at_last_step_ = 0;
  double travelled_m_ = 0.0;
  double searched_at_m_ = -1e9;
  /// The stations of the last metres: where the base was by odometry, how far driven by then.
  struct Passed {
    Pose2 track_T_base;
    double travelled_m;
    joint::Station station;
  };
  std::deque<Passed> passed_;
  LocalizationStatus status_ = LocalizationStatus::kSearching;
  std::optional<Pose2> candidate_;  ///< the place that was best at the last step
  double agreed_m_ = 0.0;           ///< for how long it has been probable enough
  double doubted_m_ = 0.0;          ///< for how long the published pose has been improbable
  double probability_ = 0.0;
};

static_assert(Localizer<Joint>);

}  // namespace mstsl
