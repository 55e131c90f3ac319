#pragma once

#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mstsl/core/stamp.hpp"

namespace mstsl {

/// One surveyed sample: where the magnetometer was, and the field there, turned into the map frame.
struct Fingerprint {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  Eigen::Vector3d field_uT = Eigen::Vector3d::Zero();
  double heading_rad =
      0.0;          ///< yaw of the robot in the map then: it turns a bias of the sensor into the map frame
  int session = 0;  ///< which of the logs it comes from: one sensor, one bias

  /// Turns a vector of the robot's base into the map frame.
  Eigen::Matrix3d map_R_base() const {
    return Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }
};

/// A drive that a field map is made of: what Fingerprint::session counts.
struct SurveyDrive {
  std::string name;   ///< of its log
  Stamp first, last;  ///< by the clock of the log
  friend bool operator==(const SurveyDrive&, const SurveyDrive&) = default;
};

/// A fingerprint that a later drive found to hold no longer.
struct ReplacedFingerprint {
  Fingerprint fingerprint;
  int by_session = 0;
};

/// What a field model says of one place: mean and variance of each component, map frame.
struct FieldPrediction {
  Eigen::Vector3d mean_uT = Eigen::Vector3d::Zero();
  Eigen::Vector3d variance_uT2 = Eigen::Vector3d::Zero();
};

}  // namespace mstsl
