#include "mstsl/datasets/measured_drive.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/stamp.hpp"
#include "mstsl/sim/drive.hpp"

namespace mstsl::datasets {
namespace {

// Parts of the randomness of one log.
constexpr std::uint64_t kHeadingStream = 1;
constexpr std::uint64_t kSensorStream = 2;

/// The recordings have no time of day; a fixed one keeps the logs the same bytes.
constexpr Stamp kStart = Stamp::from_parts(1'000'000'000, 0);

/// Turning by an angle from rest to rest as fast as limited rate and acceleration allow.
class Turn {
 public:
  Turn(double angle_rad, double rate_rad_s, double acceleration_rad_s2)
      : sign_(angle_rad < 0.0 ? -1.0 : 1.0),
        angle_rad_(std::abs(angle_rad)),
        acceleration_rad_s2_(acceleration_rad_s2),
        ramp_s_(std::min(rate_rad_s / acceleration_rad_s2, std::sqrt(angle_rad_ / acceleration_rad_s2))),
        cruise_s_(angle_rad_ > 0.0 ? angle_rad_ / (acceleration_rad_s2 * ramp_s_) - ramp_s_ : 0.0) {}

  double duration_s() const { return 2.0 * ramp_s_ + cruise_s_; }

  double angle_at(double seconds) const {
    const double t = std::clamp(seconds, 0.0, duration_s());
    const double left = duration_s() - t;
    const double half = acceleration_rad_s2_ / 2.0;
    if (t < ramp_s_) return sign_ * half * t * t;
    if (left < ramp_s_) return sign_ * (angle_rad_ - half * left * left);
    return sign_ * acceleration_rad_s2_ * ramp_s_ * (t - ramp_s_ / 2.0);
  }

 private:
  double sign_;
  double angle_rad_;
  double acceleration_rad_s2_;
  double ramp_s_;
  double cruise_s_;
};

sim::Trajectory drive_along(const std::vector<Fingerprint>& rows, const sim::MotionOptions& motion) {
  std::vector<Eigen::Vector2d> points_m;
  for (const Fingerprint& row : rows) points_m.push_back(row.position_m);
  return sim::along_points(points_m, motion, kHeadingWindow_m, kStart);
}

Log log_of(std::shared_ptr<const sim::World> world, std::vector<Fingerprint> rows,
           const sim::RobotOptions& robot, sim::Trajectory trajectory, const Random& random) {
  const auto field = std::make_shared<const PathField>(std::move(rows));
  const auto source = [field](const Pose2&, const Eigen::Vector3d& position_m) {
    return field->field_uT(position_m.head<2>());
  };
  return {robot.rig, [world = std::move(world), robot, trajectory = std::move(trajectory), source,
                      sensors = random.fork(kSensorStream)](const sim::DriveSinks& sinks) {
            sim::drive(*world, robot, trajectory, sensors, sinks, source);
          }};
}

}  // namespace

sim::Trajectory with_turn_at_start(const sim::Trajectory& drive, double start_yaw_rad,
                                   const sim::MotionOptions& motion) {
  assert(!drive.poses.empty());
  const Pose2 first = drive.poses.front();
  const Turn turn(angle_between(start_yaw_rad, first.yaw), motion.turn_rate_rad_s,
                  motion.turn_acceleration_rad_s2);
  const double before_s = 2.0 * motion.standstill_s + turn.duration_s();
  const auto steps = static_cast<std::size_t>(std::ceil(before_s / drive.step_s));
  sim::Trajectory whole{drive.start, drive.step_s, {}};
  for (std::size_t i = 0; i < steps; ++i) {
    const double turning_s = static_cast<double>(i) * drive.step_s - motion.standstill_s;
    whole.poses.push_back(Pose2::from(first.position(), start_yaw_rad + turn.angle_at(turning_s)));
  }
  whole.poses.insert(whole.poses.end(), drive.poses.begin(), drive.poses.end());
  return whole;
}

Log measured_survey(std::shared_ptr<const sim::World> world, std::vector<Fingerprint> rows,
                    sim::RobotOptions robot, const Random& random) {
  robot.lidar.rate_hz = 0.0;
  sim::Trajectory trajectory = drive_along(rows, robot.motion);
  return log_of(std::move(world), std::move(rows), robot, std::move(trajectory), random);
}

Log point_survey(std::shared_ptr<const sim::World> world, std::vector<Fingerprint> points,
                 sim::RobotOptions robot, const Random& random) {
  robot.lidar.rate_hz = 0.0;
  const sim::Trajectory trajectory = drive_along(points, robot.motion);
  const double reach_m = robot.motion.speed_m_s / robot.magnetometer.rate_hz;
  const auto at_a_point = [points, trajectory, reach_m](Stamp stamp) {
    const Eigen::Vector2d place_m = trajectory.at(stamp - trajectory.start).position();
    return std::any_of(points.begin(), points.end(), [&](const Fingerprint& point) {
      return (point.position_m - place_m).norm() <= reach_m;
    });
  };
  const Log everywhere = log_of(std::move(world), std::move(points), robot, trajectory, random);
  return {robot.rig, [everywhere, at_a_point](const sim::DriveSinks& sinks) {
            const auto event = [&](const SensorEvent& reading) {
              if (std::holds_alternative<FieldReading>(reading) && !at_a_point(stamp_of(reading))) return;
              if (sinks.event) sinks.event(reading);
            };
            everywhere.play({event, sinks.truth});
          }};
}

Log measured_run(std::shared_ptr<const sim::World> world, std::vector<Fingerprint> rows,
                 sim::RobotOptions robot, const Random& random) {
  const double start_yaw_rad = random.fork(kHeadingStream).uniform(-kPi, kPi);
  sim::Trajectory trajectory =
      with_turn_at_start(drive_along(rows, robot.motion), start_yaw_rad, robot.motion);
  return log_of(std::move(world), std::move(rows), robot, std::move(trajectory), random);
}

}  // namespace mstsl::datasets
