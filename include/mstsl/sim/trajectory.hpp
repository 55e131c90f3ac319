#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/core/stamp.hpp"
#include "mstsl/sim/route.hpp"

namespace mstsl::sim {

/// How a robot truly moved: its pose (map_T_base) at equal steps of time, interpolated between.
struct Trajectory {
  Stamp start;
  double step_s = 0.01;
  std::vector<Pose2> poses;

  double duration_s() const { return poses.empty() ? 0.0 : step_s * static_cast<double>(poses.size() - 1); }
  Pose2 at(double seconds_from_start) const;
};

/// Metres travelled.
double length(const Trajectory& trajectory);

/// How the robot is driven.
struct MotionOptions {
  double speed_m_s = 0.7;  ///< the usual pace of such robots (0.6-0.8)
  double acceleration_m_s2 = 0.5;
  double turn_rate_rad_s = 0.8;  ///< when turning in place
  double turn_acceleration_rad_s2 = 1.5;
  double wander_m = 0.05;         ///< SD of the slow sideways wander about the route
  double wander_length_m = 4.0;   ///< distance over which the wander forgets itself
  double initial_turn_rad = 0.0;  ///< the commanded turn by beta before setting out (paper, section III-A.3)
  double standstill_s = 1.0;      ///< stands this long at the start, and again after the initial turn
};

/// Drives a route as a differential-drive robot does: stands, turns by `initial_turn_rad`, stands, turns in
/// place towards each leg where it must, and tracks the legs with limited speed and acceleration.
Trajectory follow(const Route& route, const MotionOptions& motion, Stamp start, const Random& random);

/// Exactly along given points (a path measured by someone else), heading along the path smoothed over
/// `heading_window_m`, at the speed of `motion`; no wander, no stops.
Trajectory along_points(const std::vector<Eigen::Vector2d>& points_m, const MotionOptions& motion,
                        double heading_window_m, Stamp start);

}  // namespace mstsl::sim
