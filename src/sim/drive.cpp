#include "mstsl/sim/drive.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace mstsl::sim {
namespace {

using Eigen::Vector3d;

enum Stream : std::uint64_t { kOdometry = 1, kMagnetometer, kImu, kLidar, kPeople, kMotion };

/// The times at which one sensor reports, counted rather than summed so that they do not drift.
class Clock {
 public:
  explicit Clock(double rate_hz) : rate_hz_(rate_hz) {}
  double next_s() const {
    return rate_hz_ > 0 ? static_cast<double>(count_) / rate_hz_ : std::numeric_limits<double>::infinity();
  }
  double period_s() const { return 1.0 / rate_hz_; }
  void tick() { ++count_; }

 private:
  double rate_hz_;
  std::int64_t count_ = 0;
};

class Gyroscope {
 public:
  Gyroscope(const ImuOptions& options, const Random& random) : options_(options), random_(random) {
    for (int axis = 0; axis < 3; ++axis) bias_rad_s_[axis] = random_.normal(0, options.bias_sigma_rad_s);
  }
  Vector3d read(const Vector3d& true_rates_rad_s) {
    Vector3d rates = true_rates_rad_s + bias_rad_s_;
    for (int axis = 0; axis < 3; ++axis) rates[axis] += random_.normal(0, options_.noise_rad_s);
    return rates;
  }

 private:
  ImuOptions options_;
  Random random_;
  Vector3d bias_rad_s_ = Vector3d::Zero();
};

/// Forward speed and turn rate at a time.
struct Twist {
  double forward_m_s, turn_rad_s;
};

Twist twist_at(const Trajectory& trajectory, double seconds) {
  const double half = 0.5 * trajectory.step_s;
  const Pose2 step = between(trajectory.at(seconds - half), trajectory.at(seconds + half));
  return {step.x / trajectory.step_s, step.yaw / trajectory.step_s};
}

}  // namespace

void drive(const World& world, const RobotOptions& robot, const Trajectory& trajectory, const Random& random,
           const DriveSinks& sinks, const FieldSource& field) {
  if (trajectory.poses.empty()) return;
  const auto send = [&](const SensorEvent& event) {
    if (sinks.event) sinks.event(event);
  };
  WheelOdometry odometry(robot.odometry, random.fork(kOdometry));
  Magnetometer magnetometer(robot.magnetometer, random.fork(kMagnetometer));
  Gyroscope gyroscope(robot.imu, random.fork(kImu));
  Random lidar_random = random.fork(kLidar);
  const People people(world, robot.people, random.fork(kPeople));
  const Eigen::Matrix3d base_R_sensor = robot.rig.base_T_magnetometer.linear();

  Pose2 last = trajectory.at(0.0);
  const auto odometry_at = [&](double t) {
    const Pose2 now = trajectory.at(t);
    const Pose2& counted = odometry.advance(between(last, now));
    last = now;
    if (sinks.truth) sinks.truth({trajectory.start + t, now});
    send(OdometryReading{trajectory.start + t, counted});
  };
  Clock mag_clock(robot.magnetometer.rate_hz);
  const auto field_at = [&](double t) {
    const Pose2 map_T_base = trajectory.at(t);
    const Eigen::Isometry3d map_T_sensor = to_isometry3(map_T_base) * robot.rig.base_T_magnetometer;
    const Vector3d position = map_T_sensor.translation();
    const Vector3d field_map = field ? field(map_T_base, position) : world.field_uT(position);
    const Twist twist = twist_at(trajectory, t);
    const double rim = 0.5 * robot.odometry.wheel_base_m * twist.turn_rad_s;
    send(
        FieldReading{trajectory.start + t,
                     magnetometer.read(map_T_sensor.linear().transpose() * field_map, twist.forward_m_s - rim,
                                       twist.forward_m_s + rim, mag_clock.period_s())});
  };
  const auto rates_at = [&](double t) {
    const Vector3d rates = base_R_sensor.transpose() * Vector3d(0, 0, twist_at(trajectory, t).turn_rad_s);
    send(ImuReading{trajectory.start + t, gyroscope.read(rates), {}});
  };
  const auto scan_at = [&](double t) {
    if (sinks.event)
      send(scan(world, people, trajectory, t, robot.rig.base_T_laser, robot.lidar, lidar_random));
  };

  const double end_s = trajectory.duration_s() + 1e-9;
  Clock odometry_clock(robot.odometry.rate_hz), imu_clock(robot.imu.rate_hz),
      lidar_clock(robot.lidar.rate_hz);
  while (true) {
    const double t =
        std::min({odometry_clock.next_s(), mag_clock.next_s(), imu_clock.next_s(), lidar_clock.next_s()});
    if (!(t <= end_s)) break;
    if (odometry_clock.next_s() == t) odometry_at(t), odometry_clock.tick();
    if (mag_clock.next_s() == t) field_at(t), mag_clock.tick();
    if (imu_clock.next_s() == t) rates_at(t), imu_clock.tick();
    if (lidar_clock.next_s() == t) scan_at(t), lidar_clock.tick();
  }
}

void drive(const World& world, const RobotOptions& robot, const Route& route, Stamp start,
           const Random& random, const DriveSinks& sinks, const FieldSource& field) {
  drive(world, robot, follow(route, robot.motion, start, random.fork(kMotion)), random, sinks, field);
}

LaserScan first_scan(const World& world, const RobotOptions& robot, const Route& route, Stamp start,
                     const Random& random) {
  if (route.waypoints_m.empty()) return {};
  const Trajectory standing{start, 0.01, {Pose2::from(route.waypoints_m.front(), route.start_yaw_rad)}};
  const People people(world, robot.people, random.fork(kPeople));
  Random lidar_random = random.fork(kLidar);
  return scan(world, people, standing, 0.0, robot.rig.base_T_laser, robot.lidar, lidar_random);
}

}  // namespace mstsl::sim
