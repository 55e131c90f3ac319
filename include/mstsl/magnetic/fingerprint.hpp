#pragma once

#include <Eigen/Core>

namespace mstsl {

/// One surveyed sample: where the magnetometer was, and the field there, turned into the map frame.
struct Fingerprint {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  Eigen::Vector3d field_uT = Eigen::Vector3d::Zero();
  double heading_rad =
      0.0;          ///< yaw of the robot in the map then: it turns a bias of the sensor into the map frame
  int session = 0;  ///< which of the logs it comes from: one sensor, one bias
};

/// What a field model says of one place: mean and variance of each component, map frame.
struct FieldPrediction {
  Eigen::Vector3d mean_uT = Eigen::Vector3d::Zero();
  Eigen::Vector3d variance_uT2 = Eigen::Vector3d::Zero();
};

}  // namespace mstsl
