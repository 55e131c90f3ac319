#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "mstsl/core/sensor_data.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/sim/drive.hpp"
#include "mstsl/sim/robot.hpp"

/// Real recordings turned into logs that the whole system can be tried on. No public recording has LiDAR,
/// odometry and a magnetometer, so each data set here is made of real parts and simulated ones, and says
/// which are which.
namespace mstsl::datasets {

/// A log to be: what the sensors say, in time order, and apart from it the truth.
struct Log {
  Rig rig;
  std::function<void(const sim::DriveSinks&)> play;  ///< may be called again; says the same each time
};

/// A building with surveys of its magnetic field and runs to be localized in it.
struct Dataset {
  OccupancyGrid map;
  std::vector<Log> surveys;  ///< their truth belongs into the log
  std::vector<Log> runs;     ///< their truth does not
  std::string provenance;    ///< what is real, what is simulated, from where; plain text for people
  std::vector<Log> checks;   ///< other drives, truth within: what a map of the field is held against
};

/// How many runs are cut out of a recording, and how long they are.
struct RunOptions {
  std::size_t count = 20;
  double length_m = 15.0;  ///< a fix after more than 10 m counts as a failure (paper, section IV-B)
};

/// The simulator's robot, with a magnetometer that adds nothing to readings which hold a real one's errors
/// already.
sim::RobotOptions robot_with_real_magnetometer();

}  // namespace mstsl::datasets
