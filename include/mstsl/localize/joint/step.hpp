#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/stamp.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl::joint {

/// The field at one place on the way: the mean of the readings over a few centimetres of travel.
struct Station {
  Pose2 base_T_then;  ///< where the base was at the station, seen from where it is at the step's end
  Eigen::Vector3d base_field_uT = Eigen::Vector3d::Zero();  ///< in the axes of the base as it stood then
  double speed_m_s = 0.0;                                   ///< forward, by odometry: drive motors disturb
  double variance_uT2 = 0.0;                                ///< of the mean, from the readings' own scatter
  /// Way of the magnetometer since the last station (m); infinite for the first.
  double since_last_m = std::numeric_limits<double>::infinity();
};

/// What came in between two scans that are worth a step, ready for every hypothesis.
struct Step {
  Stamp stamp;
  Pose2 last_T_base;        ///< motion since the last step, by odometry
  bool broken = false;      ///< odometry was interrupted: the motion is not known
  bool after_dark = false;  ///< neither scan nor field came for a while: the robot may have been carried
  std::vector<Station> stations;
  PointSet points_base_m;  ///< of the scan; empty where it tells nothing
};

}  // namespace mstsl::joint
