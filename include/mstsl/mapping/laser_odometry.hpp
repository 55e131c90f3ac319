#pragma once

#include <optional>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/scan/fit_around.hpp"
#include "mstsl/scan/scanned_walls.hpp"

namespace mstsl {

struct LaserOdometryOptions {
  /// How much faster or slower than a moment ago a robot may be at the next scan, as a shift and a turn (SD).
  double shift_sd_m = 0.08;
  double turn_sd_rad = radians(4.0);
  /// A scan that scores less looks around.
  double search_below = 0.7;
  Surroundings around{.steps = 2, .step_m = 0.15, .corners = true, .turns = 5, .turn_rad = 0.05};
  /// The walls are those of the scans of the last so many shifts of a quarter metre.
  double redrawn_after_m = 8.0;
  double max_range_m = 20.0;
  FitOptions fit = {.sigma_m = 0.08, .points_per_error = 1.0, .max_iterations = 12};
};

/// Odometry for a robot that has none, or a log that lacks it: each scan is matched to the walls of those
/// before it, as if the robot went on as it did. Along a bare corridor it cannot see how far it goes.
class LaserOdometry {
 public:
  explicit LaserOdometry(const Rig& rig, const LaserOdometryOptions& options = {});

  /// The reading at the scan's stamp. Expects scans in time order.
  OdometryReading observe(const LaserScan& scan);

 private:
  Rig rig_;
  LaserOdometryOptions options_;
  ScannedWalls walls_;
  std::optional<Stamp> last_;
  Pose2 odom_T_base_, drawn_;
  Pose2 motion_;            ///< over the last scan interval ...
  double interval_s_ = 0.0;  ///< ... which lasted so long
  double since_redrawn_m_ = 0.0;
};

}  // namespace mstsl
