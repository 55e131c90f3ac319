#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/localize/field_witness.hpp"
#include "mstsl/localize/lidar_stage.hpp"
#include "mstsl/localize/localizer.hpp"
#include "mstsl/localize/odometry_track.hpp"
#include "mstsl/localize/tracker.hpp"

namespace mstsl {

struct TwoStepOptions {
  AlignOptions align;
  InitialiseOptions initialise;
  LidarStageOptions lidar;
  TrackerOptions tracker;
  FieldWitnessOptions field_witness;
  OdometryTrackOptions odometry;
  /// A scan is processed after so much motion (m, rad) or time (s) since the last one that was.
  double process_every_m = 0.1;
  double process_every_rad = radians(5.0);
  double process_every_s = 0.5;
  /// Scans with fewer returns say nothing.
  std::size_t min_returns = 30;
  std::uint64_t seed = 1;  ///< of the RANSAC line
};

/// What is wrong with the options, if anything, in one sentence.
std::optional<Error> invalid(const TwoStepOptions& options);

/// The paper's method: field readings give the initial hypotheses (step 1), LiDAR and odometry the one that
/// is right (step 2); from then on the pose is tracked, and searched again when it is lost.
class TwoStep {
 public:
  /// Expects valid options.
  TwoStep(std::shared_ptr<const LocalizationMaps> maps, const Rig& rig, const TwoStepOptions& options = {});

  void observe(const OdometryReading& odometry) { track_.add(odometry); }
  void observe(const OdometryRestart& restart) { track_.restart(restart); }
  void observe(const LaserScan& scan);
  void observe(const FieldReading& field);
  Estimate estimate() const;
  LocalizerReport report() const;

  /// The hypotheses on their way, with the reasons why some were removed (paper Fig. 4); nothing outside
  /// step 2.
  const std::vector<LidarHypothesis>* hypotheses() const;

 private:
  /// Step 1: no hypotheses yet.
  struct Gathering {
    FirstReading reading;
  };
  /// Step 2.
  struct Comparing {
    LidarStage stage;
  };
  struct Tracking {
    Tracker tracker;
    double probability = 0.0;
    FieldWitness field;
  };
  struct Counts {
    std::uint64_t late_scans = 0, blind_scans = 0, scans_without_odometry = 0;
    std::uint64_t bad_field = 0, field_without_odometry = 0, field_used = 0;
    std::uint64_t searches = 0, times_lost = 0, all_rejected = 0;
    std::uint64_t removed[3] = {0, 0, 0};  ///< by Rejection
  };
  /// One scan made ready, and the motion since the last one.
  struct Step {
    Stamp stamp;
    Pose2 track_T_base;
    Pose2 last_T_base;
    bool broken = false;
    std::vector<BeamReturn> returns;
  };

  bool worth_processing(Stamp stamp, const Pose2& track_T_base) const;
  Step make_step(const LaserScan& scan, const Pose2& track_T_base) const;
  void advance(const Step& step);
  void advance(Gathering& gathering, const Step& step);
  void advance(Comparing& comparing, const Step& step);
  void advance(Tracking& tracking, const Step& step);
  void ask_field(Tracking& tracking, Stamp stamp) const;
  void search_again();
  void count_removed(const std::vector<LidarHypothesis>& before, const std::vector<LidarHypothesis>& after);

  std::shared_ptr<const LocalizationMaps> maps_;
  Rig rig_;
  TwoStepOptions options_;
  Random random_;
  OdometryTrack track_;
  std::variant<Gathering, Comparing, Tracking> phase_;
  Counts counts_;
  std::optional<Stamp> last_scan_, last_field_;
  Eigen::Vector3d last_base_field_uT_ = Eigen::Vector3d::Zero();
  std::optional<TimedPose> last_step_;
  std::uint64_t breaks_at_last_step_ = 0;
  double travelled_at_last_step_m_ = 0.0;
  bool was_localized_ = false;
};

static_assert(Localizer<TwoStep>);

}  // namespace mstsl
