#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/localize/localization_maps.hpp"
#include "mstsl/localize/localizer.hpp"
#include "mstsl/localize/motion.hpp"
#include "mstsl/localize/odometry_track.hpp"

namespace mstsl {

struct MagFilterOptions {
  std::size_t particles = 5000;
  /// SD of a reading beyond the map's own variance, per axis (uT).
  double sigma_uT = 1.0;
  /// Power that a reading's likelihood is taken to: 1 takes readings for independent.
  double temper = 1.0;
  /// An answer is given from this share of the weight within 0.5 m and 10 deg of the mean on.
  double answer_from = 0.9;
  double update_every_m = 0.1;
  double update_every_rad = radians(5.0);
  double update_every_s = 0.5;
  OdometryNoise noise;
  /// Added to every particle at resampling, so that copies part (Gordon et al. 1993).
  double roughen_m = 0.03;
  double roughen_rad = 0.01;
  OdometryTrackOptions odometry;
  std::uint64_t seed = 1;
};

/// Baseline after PF-Mag: a particle filter on the magnetic field alone (with the occupancy map for where a
/// robot can be). It hears no scan but for the times at which it answers.
class MagFilter {
 public:
  MagFilter(std::shared_ptr<const LocalizationMaps> maps, const Rig& rig,
            const MagFilterOptions& options = {});

  void observe(const OdometryReading& odometry) { track_.add(odometry); }
  void observe(const OdometryRestart& restart) { track_.restart(restart); }
  void observe(const FieldReading& field);
  void observe(const LaserScan& scan);
  Estimate estimate() const;
  LocalizerReport report() const;

 private:
  struct Particle {
    Pose2 map_T_base;
    double weight = 1.0;
  };
  void spread();
  void move(const Pose2& last_T_base);
  void weigh(const Eigen::Vector3d& base_field_uT);
  void resample();
  void conclude();

  std::shared_ptr<const LocalizationMaps> maps_;
  Rig rig_;
  MagFilterOptions options_;
  Random random_;
  OdometryTrack track_;
  std::vector<Particle> particles_;
  Eigen::Vector3d track_field_sum_uT_ = Eigen::Vector3d::Zero();  ///< of the readings since the last update
  std::size_t readings_ = 0;
  std::optional<Stamp> last_scan_;
  std::optional<TimedPose> last_step_;
  double travelled_at_last_step_m_ = 0.0;
  Pose2 mean_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  double probability_ = 0.0;
  bool was_localized_ = false;
  std::uint64_t updates_ = 0, resamplings_ = 0;
};

static_assert(Localizer<MagFilter>);

}  // namespace mstsl
