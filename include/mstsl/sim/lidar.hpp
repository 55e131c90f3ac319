#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/sim/trajectory.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::sim {

/// A 2-D scanning rangefinder. Defaults: Hokuyo UTM-30LX, from its data sheet.
struct LidarOptions {
  double rate_hz = 40.0;  ///< scans a second; 0 switches it off
  double field_of_view_rad = radians(270.0);
  int beams = 1081;               ///< 0.25 deg apart
  double sweep_s = 0.025 * 0.75;  ///< first to last beam: 270 of 360 deg of a 25 ms turn
  double range_min_m = 0.1;
  double range_max_m = 30.0;
  double near_noise_m = 0.010;  ///< SD below 10 m
  double far_noise_m = 0.030;   ///< SD from 10 m on
  double dropout = 0.002;       ///< share of beams lost for no visible reason
  double reflectivity = 0.5;    ///< of walls, diffuse (painted plaster, concrete)
  /// A white sheet (0.9) straight ahead is seen half the time at this range; sets which glancing beams are
  /// lost.
  double detection_range_m = 60.0;
};

/// People walking to and fro along the lanes; a lidar at shin height sees two legs each.
struct PeopleOptions {
  double per_100m = 1.0;  ///< people per 100 m of lane
  double speed_m_s = 1.2;
  double leg_radius_m = 0.06;
  double keep_away_m = 0.5;  ///< they step aside rather than stand nearer to the robot's centre
};

struct Leg {
  Eigen::Vector2d center_m;
  double radius_m;
};

class People {
 public:
  People() = default;
  People(const World& world, const PeopleOptions& options, const Random& random);
  /// The legs of all people within `radius_m` of the robot, `seconds` after the start.
  std::vector<Leg> legs(double seconds, const Eigen::Vector2d& robot_m, double radius_m) const;

 private:
  struct Walker {
    Segment path;
    double phase_m;
    double speed_m_s;
  };
  PeopleOptions options_;
  std::vector<Walker> walkers_;
};

/// One scan whose first beam is taken `seconds` after the trajectory's start, each beam from where the robot
/// then is.
LaserScan scan(const World& world, const People& people, const Trajectory& trajectory, double seconds,
               const Eigen::Isometry3d& base_T_laser, const LidarOptions& options, Random& random);

}  // namespace mstsl::sim
