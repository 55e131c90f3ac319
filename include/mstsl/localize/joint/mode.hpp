#pragma once

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/localize/joint/step.hpp"
#include "mstsl/magnetic/field_sampler.hpp"
#include "mstsl/scan/fit_to_walls.hpp"

/// One Gaussian mode of the joint posterior over pose, magnetometer bias and the field map's own error. The
/// derivation is in docs/joint.md.
namespace mstsl::joint {

inline constexpr int kStates = 15;
using Covariance = Eigen::Matrix<double, kStates, kStates>;
using Vector = Eigen::Matrix<double, kStates, 1>;

/// Where the parts of the state lie: pose (x, y in m, yaw in rad; map), bias (uT, base axes), field of the
/// drive motors at 1 m/s (uT, base axes), how far the field here is off the map (uT, map axes), and how that
/// changes along the way (in lengths of its correlation: uT).
enum Part : int { kPose = 0, kBias = 3, kMotor = 6, kMapError = 9, kMapErrorSlope = 12 };

/// How far off the stations of the last metre were against what was expected, squared: the variance that the
/// map claims is right on average, and wrong by a factor that lasts for a while. Conjugate (inverse gamma),
/// forgetting with the way.
struct ErrorScale {
  double weight = 4.0, squares = 4.0;  ///< numbers of deviations, and their squares in variances

  double factor() const { return squares / weight; }
  /// Three deviations whose squares sum to `squared`, `way_m` after the last; `news` is what part of them (0
  /// .. 1) was not told there already.
  void learn(double squared, double way_m, double length_m, double news);
};

struct Mode {
  Pose2 map_T_base;
  Vector state = Vector::Zero();  ///< the pose's three entries stay 0: it is kept in map_T_base
  Covariance covariance = Covariance::Zero();
  double log_weight = 0.0;  ///< natural log; normalised by ModeBank
  double changed = 0.0;     ///< probability that the map is of no use here: steel was moved
  ErrorScale scale = {};
  double scan_account = 0.0;   ///< log evidence of the present place by scans that is in log_weight already
  double field_account = 0.0;  ///< the part of log_weight that the field told

  Eigen::Matrix3d pose_covariance() const { return covariance.topLeftCorner<3, 3>(); }
};

/// What is assumed of the magnetometer and of the field map's truth.
struct FieldModel {
  /// Hard iron left on the robot (uT per axis): 6-10 uT are usual without a calibration.
  double bias_sigma_uT = 7.0;
  /// Field of the drive motors at 1 m/s (uT per axis).
  double motor_sigma_uT = 4.0;
  /// How far the bias wanders over a metre (uT).
  double bias_walk_uT = 0.1;
  /// A station's error beyond its readings' scatter: timing, tilt of the floor (uT).
  double station_sigma_uT = 0.3;
  /// The map's error at run time over what the regression claims, and a floor (uT): on held-out drives 2-4 in
  /// variance.
  double map_error_factor = 1.5;
  double map_error_floor_uT = 1.0;
  /// Length (m) of that error's correlation along the way, Matern 3/2: it was measured to be 0.8-0.9 at 0.25
  /// m and 0.2 at 1 m, and this one is 0.83 and 0.20.
  double error_length_m = 0.58;
  /// Part of that error's variance which is each station's own: where a map is off by much it is so within
  /// centimetres, and a pose is not known to centimetres. 0.06 to 0.2 on held-out lanes. None where the map
  /// knows nothing: the error is then the field.
  double error_own_share = 0.12;
  /// Way (m) after which that part is another: stations taken while the robot turns on the spot are off by
  /// the same.
  double error_own_length_m = 0.04;
  /// What is off otherwise while it turns on the spot (uT): soft iron of 2 %, a floor that tilts by 1 deg.
  double turning_sigma_uT = 0.7;
  /// Steel that was moved makes the map useless for a while: how often on the way that begins, one in so many
  /// metres, and for how long it lasts: the length of a parked car, half that of a rack.
  double change_every_m = 8.0;
  double change_length_m = 2.0;
  /// For how long (m) the map's variance stays wrong by the same factor.
  double scale_length_m = 1.0;
};

/// A mode at a pose of covariance `pose_covariance`, nothing known of the magnetometer.
Mode make_mode(const Pose2& map_T_base, const Eigen::Matrix3d& pose_covariance, const FieldModel& model);

/// Moves a mode by odometry's motion, whose covariance is given in the axes of the base before it.
void predict(Mode& mode, const Pose2& last_T_base, const Eigen::Matrix3d& motion_covariance,
             double bias_walk_uT);

/// Takes in a station: an extended Kalman update. The map's error is a stationary process along the way
/// (Matern 3/2: smooth, as fields are), so that near stations do not count as independent; where steel was
/// moved it is as large as the field itself. Returns the natural log of the station's density under the mode.
double update_by_field(Mode& mode, const Station& station, const FieldSampler& field,
                       const Eigen::Vector2d& magnetometer_m, const FieldModel& model);

/// Puts a mode's pose where a scan fits, its own belief in the pose given up: what the field told of the
/// magnetometer is kept, loosened by `loosen_uT`.
void reseat(Mode& mode, const WallFit& fit, const Eigen::Matrix3d& pose_covariance, double loosen_uT);

/// Takes in a scan's fit: the pose becomes the fit's, and what correlates with the pose follows.
void update_by_scan(Mode& mode, const WallFit& fit);

}  // namespace mstsl::joint
