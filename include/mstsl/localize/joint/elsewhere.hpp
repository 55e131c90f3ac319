#pragma once

#include "mstsl/localize/joint/mode.hpp"

namespace mstsl::joint {

/// "None of these": the robot is at a place that no mode stands for, where the map says nothing. It predicts
/// the field as well as can be without a map: some mean that does not change when the robot turns, and on top
/// of it a field that wanders along the way as strongly as this building's does. A mode has to beat that.
class Elsewhere {
 public:
  Elsewhere(const FieldSampler& field, const FieldModel& model);

  /// The robot turned.
  void predict(double turn_rad) { yaw_rad_ += turn_rad; }
  /// Takes in a station; the natural log of its density here.
  double update_by_field(const Station& station);

 private:
  FieldModel model_;
  Eigen::Vector3d spread_uT_;
  double length_m_;
  double yaw_rad_ = 0.0;  ///< from where it was at the start
  /// In place of a pose: the mean field in the axes that the base had at the start; the rest as in a mode.
  Vector state_ = Vector::Zero();
  Covariance covariance_ = Covariance::Zero();
};

}  // namespace mstsl::joint
