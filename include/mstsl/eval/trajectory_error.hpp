#pragma once

#include <cstddef>
#include <span>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/eval/statistics.hpp"

namespace mstsl {

/// How far a trajectory is from the true one, after the rigid motion that brings them together best.
struct TrajectoryError {
  Pose2 true_T_map;    ///< that motion (Umeyama 1991, without scale)
  double rms_m = 0.0;  ///< absolute trajectory error
  double max_m = 0.0;
};

/// Compares poses of equal number. Expects at least one.
TrajectoryError trajectory_error(std::span<const TimedPose> estimated, std::span<const Pose2> truth);

/// Errors of relations between two poses, as a robot that uses the map would meet them (Kuemmerle et al.,
/// "On measuring the accuracy of SLAM algorithms", 2009): no alignment, nothing that drifts away.
struct RelationErrors {
  Spread translation_m;
  Spread rotation_deg;
};

/// Relations between poses a metre driven apart ...
RelationErrors local_errors(std::span<const TimedPose> estimated, std::span<const Pose2> truth);
/// ... and between each pose and the nearest one within a metre that came at least 10 m of way later.
RelationErrors loop_errors(std::span<const TimedPose> estimated, std::span<const Pose2> truth);

}  // namespace mstsl
