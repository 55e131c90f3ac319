#pragma once

#include <Eigen/Core>

namespace mstsl {

/// What the robot's own iron does to its magnetometer, to be undone: a constant field (hard iron) and a
/// linear distortion (soft iron), in the sensor's own axes.
struct MagnetometerCalibration {
  Eigen::Vector3d hard_iron_uT = Eigen::Vector3d::Zero();
  Eigen::Matrix3d soft_iron = Eigen::Matrix3d::Identity();

  /// The field as it would be without the robot.
  Eigen::Vector3d apply(const Eigen::Vector3d& sensor_field_uT) const {
    return soft_iron * (sensor_field_uT - hard_iron_uT);
  }
};

}  // namespace mstsl
