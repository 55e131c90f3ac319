#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/random.hpp"
#include "mstsl/datasets/dataset.hpp"
#include "mstsl/datasets/path_field.hpp"
#include "mstsl/sim/trajectory.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::datasets {

/// Length over which the heading of a measured path is taken: rows lie 2 to 10 cm apart and scatter by a
/// centimetre or two, so that the direction from one to the next means little.
inline constexpr double kHeadingWindow_m = 0.5;

/// The same drive, but before it the robot stands with another heading, turns in place the short way to where
/// the path leads, and stands again. Speeds, accelerations and how long it stands come from `motion`. Expects
/// at least one pose.
sim::Trajectory with_turn_at_start(const sim::Trajectory& drive, double start_yaw_rad,
                                   const sim::MotionOptions& motion);

/// A robot surveying: it drives along the measured rows, and its magnetometer reads what was measured there.
/// Its lidar stays off: a survey needs only poses and field.
Log measured_survey(std::shared_ptr<const sim::World> world, std::vector<Fingerprint> rows,
                    sim::RobotOptions robot, const Random& random);

/// The same over points that lie apart: the magnetometer is heard only where one was measured (within the
/// travel from one reading to the next), for nothing is known of the field between them.
Log point_survey(std::shared_ptr<const sim::World> world, std::vector<Fingerprint> points,
                 sim::RobotOptions robot, const Random& random);

/// A robot to be localized: it stands at the first row with a random heading, turns in place to the path's
/// direction (the field is the first row's meanwhile) and drives along the rows. Lidar and odometry are
/// simulated in `world`.
Log measured_run(std::shared_ptr<const sim::World> world, std::vector<Fingerprint> rows,
                 sim::RobotOptions robot, const Random& random);

}  // namespace mstsl::datasets
