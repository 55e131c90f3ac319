#include "mstsl/sim/robot.hpp"

#include <cmath>

namespace mstsl::sim {
namespace {

using Eigen::Vector3d;

Vector3d random_direction(Random& random) {
  const double up = random.uniform(-1.0, 1.0), around = random.uniform(-kPi, kPi);
  const double flat = std::sqrt(1.0 - up * up);
  return {flat * std::cos(around), flat * std::sin(around), up};
}

Vector3d normal3(double sigma, Random& random) {
  const double x = random.normal(0, sigma), y = random.normal(0, sigma), z = random.normal(0, sigma);
  return {x, y, z};
}

}  // namespace

Rig default_rig() {
  Rig rig;
  rig.base_T_laser.translation() = Vector3d(0.2, 0.0, 0.3);
  rig.base_T_magnetometer.translation() = Vector3d(0.0, 0.0, 0.7);
  return rig;
}

Rig tilted_rig(const Vector3d& roll_pitch_yaw_rad) {
  Rig rig = default_rig();
  rig.base_T_magnetometer.linear() = (Eigen::AngleAxisd(roll_pitch_yaw_rad.z(), Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(roll_pitch_yaw_rad.y(), Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(roll_pitch_yaw_rad.x(), Vector3d::UnitX()))
                                         .toRotationMatrix();
  return rig;
}

WheelOdometry::WheelOdometry(const OdometryOptions& options, const Random& random)
    : options_(options), random_(random) {
  const double common = options.scale_sigma * random_.normal();
  // Wheels whose scales differ by d turn the count by d / wheel_base for each metre.
  const double difference = options.drift_sigma_rad_per_m * options.wheel_base_m * random_.normal();
  left_scale_ = 1.0 + common - 0.5 * difference;
  right_scale_ = 1.0 + common + 0.5 * difference;
}

const Pose2& WheelOdometry::advance(const Pose2& true_motion) {
  // Arc length of a differential drive from the chord: exact for an arc.
  const double half_turn = 0.5 * true_motion.yaw;
  const double chord = std::cos(half_turn) * true_motion.x + std::sin(half_turn) * true_motion.y;
  const double sideways = -std::sin(half_turn) * true_motion.x + std::cos(half_turn) * true_motion.y;
  const double arc = std::abs(half_turn) < 1e-9 ? chord : chord * half_turn / std::sin(half_turn);
  const auto counted = [&](double rolled_m, double scale) {
    const double moved = std::abs(rolled_m);
    double count = scale * rolled_m + options_.noise_m_per_sqrt_m * std::sqrt(moved) * random_.normal();
    if (random_.chance(0.5 * options_.slips_per_m * moved))
      count -= options_.slip_m * std::log1p(-random_.uniform());
    return count;
  };
  const double left = counted(arc - options_.wheel_base_m * half_turn, left_scale_);
  const double right = counted(arc + options_.wheel_base_m * half_turn, right_scale_);
  const double turn = (right - left) / options_.wheel_base_m;
  const double sinc = std::abs(turn) < 1e-9 ? 1.0 : std::sin(0.5 * turn) / (0.5 * turn);
  const double forward = 0.5 * (left + right) * sinc;
  // A path measured by a walker also moves a little sideways; no wheel sees that, yet odometry must follow
  // the path.
  const Eigen::Vector2d step = Pose2{0, 0, 0.5 * turn} * Eigen::Vector2d(forward, sideways);
  odom_T_base_ = odom_T_base_ * Pose2{step.x(), step.y(), turn};
  return odom_T_base_;
}

Magnetometer::Magnetometer(const MagnetometerOptions& options, const Random& random)
    : options_(options), random_(random) {
  bias_uT_ = normal3(options.bias_sigma_uT, random_);
  left_motor_ = random_direction(random_);
  right_motor_ = random_direction(random_);
}

Vector3d Magnetometer::read(const Vector3d& true_field_uT, double left_m_s, double right_m_s, double dt_s) {
  bias_uT_ += normal3(options_.bias_walk_uT_per_sqrt_s * std::sqrt(dt_s), random_);
  const Vector3d motors = options_.motor_uT_per_m_s * (left_m_s * left_motor_ + right_m_s * right_motor_);
  return true_field_uT + bias_uT_ + motors + normal3(options_.noise_uT, random_);
}

}  // namespace mstsl::sim
