#pragma once

#include <optional>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/mapping/recent_walls.hpp"
#include "mstsl/scan/fit_around.hpp"

namespace mstsl {

struct LaserOdometryOptions {
  /// Scans that follow sooner (s) show nothing new.
  double every_s = 0.07;
  /// How much faster or slower than at the last scan a robot may be at the next one (SD).
  double speed_sd_m_s = 0.3;
  double turn_rate_sd_rad_s = radians(30.0);
  /// A scan that scores less looks around.
  double search_below = 0.7;
  Surroundings around{.steps = 2, .step_m = 0.15, .corners = true, .turns = 5, .turn_rad = 0.05};
  double recent_m = 8.0;  ///< scans are matched to the walls seen over the last so many metres
  double max_range_m = 40.0;
  FitOptions fit = {.sigma_m = 0.08, .points_per_error = 1.0, .max_iterations = 12};
};

/// Odometry for a robot that has none, or a log that lacks it: each scan is matched to the walls of those
/// before it, as if the robot went on as it did. Along a bare corridor it cannot see how far it goes.
class LaserOdometry {
 public:
  explicit LaserOdometry(const Rig& rig, const LaserOdometryOptions& options = {});

  /// The reading at the scan's stamp, if the scan shows something new. Expects scans in time order.
  std::optional<OdometryReading> observe(const LaserScan& scan);

 private:
  Rig rig_;
  LaserOdometryOptions options_;
  RecentWalls walls_;
  std::optional<Stamp> last_;
  Pose2 odom_T_base_, drawn_;
  Pose2 motion_;             ///< over the last scan interval ...
  double interval_s_ = 0.0;  ///< ... which lasted so long
};

}  // namespace mstsl
