#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/sim/lidar.hpp"

namespace mstsl::sim {

/// Errors of wheel odometry. Defaults: the 3 % scale and 1 deg/m drift class of a small robot on hard floor.
struct OdometryOptions {
  double rate_hz = 50.0;
  double wheel_base_m = 0.4;
  double scale_sigma = 0.03;                    ///< SD, per run, of the common relative error of both wheels
  double drift_sigma_rad_per_m = radians(1.0);  ///< SD, per run, of the turn seen when driving straight
  double noise_m_per_sqrt_m = 0.005;            ///< white error of each wheel, SD after 1 m
  double slips_per_m = 0.02;                    ///< how often a wheel slips
  double slip_m = 0.01;                         ///< mean length that a slip adds to one wheel's count
};

/// A calibrated magnetometer of the Xsens MTi class.
struct MagnetometerOptions {
  double rate_hz = 100.0;                ///< 0 switches it off
  double noise_uT = 0.1;                 ///< white, SD per reading and axis
  double bias_sigma_uT = 0.3;            ///< SD, per run and axis, of the constant error left by calibration
  double bias_walk_uT_per_sqrt_s = 0.0;  ///< slow drift of the bias
  double motor_uT_per_m_s = 0.0;         ///< field of each drive motor at the sensor per m/s of its wheel
};

struct ImuOptions {
  double rate_hz = 0.0;                     ///< gyroscope readings a second; 0 switches it off
  double noise_rad_s = radians(0.3);        ///< white, SD per reading
  double bias_sigma_rad_s = radians(0.05);  ///< SD, per run, of the constant error
};

/// Laser 0.3 m above ground and 0.2 m ahead, magnetometer upright 0.7 m above the axle (paper, Fig. 5a: as
/// high as it can be, over the robot's middle).
Rig default_rig();
/// The same, but with the magnetometer tilted (roll, pitch) and turned (yaw), rad.
Rig tilted_rig(const Eigen::Vector3d& roll_pitch_yaw_rad);

struct RobotOptions {
  Rig rig = default_rig();
  MotionOptions motion;
  OdometryOptions odometry;
  MagnetometerOptions magnetometer;
  ImuOptions imu;
  LidarOptions lidar;
  PeopleOptions people;
};

/// Odometry with one run's own errors: fed the true motion, it says what the wheels say.
class WheelOdometry {
 public:
  WheelOdometry(const OdometryOptions& options, const Random& random);
  /// Takes in the true motion since the last call; the pose counted so far.
  const Pose2& advance(const Pose2& true_motion);

 private:
  OdometryOptions options_;
  Random random_;
  double left_scale_;
  double right_scale_;
  Pose2 odom_T_base_;
};

/// A magnetometer with one run's own errors.
class Magnetometer {
 public:
  Magnetometer(const MagnetometerOptions& options, const Random& random);
  /// What it reads `dt_s` after the last reading, in a true field given in its own frame, uT, with the
  /// wheels' speeds.
  Eigen::Vector3d read(const Eigen::Vector3d& true_field_uT, double left_m_s, double right_m_s, double dt_s);
  const Eigen::Vector3d& bias_uT() const { return bias_uT_; }

 private:
  MagnetometerOptions options_;
  Random random_;
  Eigen::Vector3d bias_uT_;
  Eigen::Vector3d left_motor_;  ///< unit direction of the motor's field, in the sensor frame
  Eigen::Vector3d right_motor_;
};

}  // namespace mstsl::sim
