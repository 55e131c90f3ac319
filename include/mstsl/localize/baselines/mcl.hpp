#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "mstsl/core/angles.hpp"
#include "mstsl/localize/localization_maps.hpp"
#include "mstsl/localize/localizer.hpp"
#include "mstsl/localize/odometry_track.hpp"

namespace mstsl {

/// The defaults are those of ROS 2's AMCL (nav2_amcl): particles, KLD bounds, likelihood field, motion model,
/// and when it updates.
struct MclOptions {
  /// Particles at the start: so many per m2 of free space, between `least` and `most`.
  double particles_per_m2 = 0.0;
  std::size_t least_particles = 500;
  std::size_t most_particles = 2000;
  double kld_error = 0.05;  ///< pf_err; KLD-sampling's bins are 0.5 m and 10 deg wide
  std::size_t beams = 60;
  double sigma_hit_m = 0.2;
  double hit_share = 0.5, random_share = 0.5;
  /// Power that a scan's likelihood, the product of its beams', is taken to. AMCL adds the cubes of its
  /// beams' likelihoods, so that a scan that fits half as well again is half as likely again: about this.
  double temper = 0.02;
  double update_every_m = 0.25;
  double update_every_rad = 0.2;
  /// Noise of the wheels, AMCL's alpha1 to alpha4: m/m, rad/m and rad/rad.
  double alpha = 0.2;
  /// It has an answer when its particles' standard deviation is below this; AMCL itself publishes their mean
  /// from the first scan on.
  double answer_below_m = 0.25;
  double answer_below_rad = radians(10.0);
  double answer_after_m = 0.0;  ///< and has been for so much way
  OdometryTrackOptions odometry;
  std::uint64_t seed = 1;
};

/// Baseline: AMCL's algorithm, adaptive Monte-Carlo localization (Fox 2003) from a uniform start, as MRPT's
/// CMonteCarloLocalization2D implements it. It hears no field. Its "probability" is the share of its
/// particles within 0.5 m and 10 deg of their mean. Only in a build with MSTSL_WITH_MRPT.
class Mcl {
 public:
  Mcl(std::shared_ptr<const LocalizationMaps> maps, const Rig& rig, const MclOptions& options = {});
  Mcl(Mcl&&) noexcept;
  Mcl& operator=(Mcl&&) noexcept;
  ~Mcl();

  void observe(const OdometryReading& odometry);
  void observe(const OdometryRestart& restart);
  void observe(const FieldReading&) {}
  void observe(const LaserScan& scan);
  Estimate estimate() const;
  LocalizerReport report() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

static_assert(Localizer<Mcl>);

}  // namespace mstsl
