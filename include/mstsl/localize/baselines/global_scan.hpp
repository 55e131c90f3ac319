#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "mstsl/core/angles.hpp"
#include "mstsl/localize/localizer.hpp"
#include "mstsl/localize/odometry_track.hpp"
#include "mstsl/localize/tracker.hpp"

namespace mstsl {

struct GlobalScanOptions {
  /// A match of the whole map that scores less is none (Cartographer's global_localization_min_score).
  double min_score = 0.6;
  /// After so much motion since the last try the whole map is searched again, m.
  double try_every_m = 0.5;
  /// An answer takes so many matches of the whole map in a row, each where odometry leads from the one
  /// before.
  int agreeing = 2;
  double agree_m = 0.5;
  double agree_rad = radians(10.0);
  double spacing_m = 0.1;  ///< scan points nearer each other count once
  std::size_t max_points = 200;
  /// Sigma of the map's likelihood is LocalizationMaps'. Scans with fewer returns say nothing.
  std::size_t min_returns = 30;
  /// A scan is processed after so much motion (m, rad) or time (s), as in the two-step method.
  double process_every_m = 0.1;
  double process_every_rad = radians(5.0);
  double process_every_s = 0.5;
  TrackerOptions tracker;
  OdometryTrackOptions odometry;
};

/// Baseline after Cartographer (Hess et al. 2016, section V): the scan is matched to the whole map by branch
/// and bound, then by least squares; what a second match confirms is taken and tracked. It hears no field.
/// Its "probability" is the match's score, the only measure of trust that it has.
class GlobalScan {
 public:
  GlobalScan(std::shared_ptr<const LocalizationMaps> maps, const Rig& rig,
             const GlobalScanOptions& options = {});

  void observe(const OdometryReading& odometry) { track_.add(odometry); }
  void observe(const OdometryRestart& restart) { track_.restart(restart); }
  void observe(const FieldReading&) {}
  void observe(const LaserScan& scan);
  Estimate estimate() const;
  LocalizerReport report() const;

 private:
  /// The last match of the whole map, carried on by odometry.
  struct Candidate {
    Pose2 map_T_base;
    int agreeing = 1;
  };
  struct Match {
    Refinement refined;
    double score = 0.0;
  };

  bool worth_processing(Stamp stamp, const Pose2& track_T_base) const;
  std::optional<Match> match(const PointSet& points_base_m) const;
  void search(const PointSet& points_base_m, const Pose2& last_T_base, bool broken);

  std::shared_ptr<const LocalizationMaps> maps_;
  Rig rig_;
  GlobalScanOptions options_;
  OdometryTrack track_;
  std::optional<Stamp> last_scan_;
  std::optional<TimedPose> last_step_;  ///< in the frame `track`
  std::uint64_t breaks_at_last_step_ = 0;
  double travelled_at_last_step_m_ = 0.0;
  std::optional<double> last_try_m_;
  std::optional<Candidate> candidate_;
  std::optional<Tracker> tracker_;
  double score_ = 0.0;
  bool was_localized_ = false;
  std::uint64_t searches_ = 0, times_lost_ = 0;
};

static_assert(Localizer<GlobalScan>);

}  // namespace mstsl
