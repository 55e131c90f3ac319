#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/magnetometer_calibration.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/core/trajectory.hpp"

namespace mstsl {

struct TurnCalibrationOptions {
  double place_m = 0.2;       ///< a turn on the spot strays no further than this
  double covered_rad = 4.71;  ///< and shows this much of the circle (270 deg): less leaves the ellipse open
};

/// A calibration and how well turning on the spot could tell it.
struct TurnCalibration {
  MagnetometerCalibration calibration;
  Eigen::Vector3d hard_iron_sd_uT = Eigen::Vector3d::Zero();  ///< sensor axes
  double soft_iron_sd = 0.0;                                  ///< of an element of the matrix
  std::size_t turns = 0;                                      ///< on the spot, each at a place of its own
  std::size_t readings = 0;                                   ///< taken during them
  double uncorrected_uT = 0.0;  ///< rms change of the horizontal strength over a turn: 0 without iron
  double corrected_uT = 0.0;    ///< the same after calibration
  std::vector<std::string> warnings;
};

/// Finds a magnetometer's hard and soft iron from turns on the spot: there the building's field is one
/// vector, so that its horizontal part draws a circle in the robot's frame, and iron makes it an ellipse off
/// the centre. The ellipses of all turns share centre and shape, not size. Needs odometry to know where the
/// robot turned on the spot, and is indifferent to its errors in heading.
///
/// Turning in the plane cannot show the hard iron along the axis of rotation, the field's true strength, what
/// the vertical field induces, or a twist of the sensor about the axis of rotation: there 0, a mean strength
/// kept, 0, and no twist are assumed.
class TurnCalibrator {
 public:
  explicit TurnCalibrator(const Rig& rig, const TurnCalibrationOptions& options = {});

  // In time order; what cannot be placed (before the first odometry, not finite) is left out.
  void observe(const OdometryReading& reading);
  void observe(const FieldReading& reading);
  /// Odometry starts anew: no turn goes on across.
  void restart();

  /// Errors: no turn on the spot, a horizontal field too weak to show anything, no ellipse.
  Result<TurnCalibration> finish() const;

 private:
  struct Drive {
    Trajectory odom_T_base;
    std::vector<FieldReading> readings;
  };
  Rig rig_;
  TurnCalibrationOptions options_;
  std::vector<Drive> drives_{1};
};

}  // namespace mstsl
