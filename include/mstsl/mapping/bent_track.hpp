#pragma once

#include <span>

#include "mstsl/core/trajectory.hpp"

namespace mstsl {

/// A time at which both are known: where odometry has the robot, and where in the map it truly was.
struct TrackKnot {
  Stamp stamp;
  Pose2 track_T_base;
  Pose2 map_T_base;
};

/// map_T_base at each odometry reading and each knot: between two knots odometry's own motion, bent evenly in
/// time so that it ends where the second one was; before the first and after the last as it is. Expects both
/// in time order and a knot at least.
Trajectory bent_track(std::span<const TimedPose> track_T_base, std::span<const TrackKnot> knots);

}  // namespace mstsl
