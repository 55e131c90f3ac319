#pragma once

#include <optional>
#include <string_view>

#include "mstsl/sim/robot.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl {

/// What makes a run hard; each is off in the easy case.
struct Disturbance {
  std::string_view name;
  bool heading = false;     ///< starts at any heading, no commanded turn; else parallel to the building
  bool bias = false;        ///< magnetometer bias of SD 5 uT per axis; else 0.3, as calibrated
  bool motor = false;       ///< the motors' field, up to 5 uT at full speed
  bool odometry = false;    ///< 3 % scale, 1 deg/m drift, slip; else 0.5 %, 0.2 deg/m
  bool people = false;      ///< people on the lanes, and around the robot: up to 30 % of the beams hidden
  bool steel = false;       ///< 10 % of the spots' steel changed since the survey
  bool things = false;      ///< 10 % of the spots decided anew, for the lidar too
  bool weak_field = false;  ///< SD of the field along the lanes at most 3 uT per axis
  bool sparse = false;      ///< survey lines 1 m apart; else 0.5 m
  bool tilt = false;        ///< magnetometer mounted askew (the rig says how)
  bool turn = false;        ///< turns on the spot by any angle before it drives
  bool blind = false;       ///< no magnetometer in the runs
};

/// Nothing for a name that is not in disturbance_names().
std::optional<Disturbance> disturbance_by(std::string_view name);

/// The robot of one run. `random` draws its mounting.
sim::RobotOptions robot_for(const Disturbance& disturbance, double scan_rate_hz, int beams,
                            const Random& random);

/// The building on the day of the run.
sim::World day_of(const sim::World& surveyed, const Disturbance& disturbance, const Random& random);

}  // namespace mstsl
