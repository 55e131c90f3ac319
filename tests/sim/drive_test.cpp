#include "mstsl/sim/drive.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/sim/run.hpp"

#include "test_support.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector3d;
using test::must;

struct Recording {
  std::vector<SensorEvent> events;
  std::vector<PoseReading> truth;

  DriveSinks sinks() {
    return {[this](const SensorEvent& event) { events.push_back(event); },
            [this](const PoseReading& pose) { truth.push_back(pose); }};
  }
  template <typename T>
  std::vector<T> all() const {
    std::vector<T> readings;
    for (const SensorEvent& event : events)
      if (const T* reading = std::get_if<T>(&event)) readings.push_back(*reading);
    return readings;
  }
};

class Drive : public ::testing::Test {
 protected:
  Recording record(const RobotOptions& robot, const FieldSource& field = {}, std::uint64_t seed = 3) const {
    Recording recording;
    drive(world_, robot, route_, Stamp::from_seconds(1e9), Random(seed), recording.sinks(), field);
    return recording;
  }
  static RobotOptions few_beams() {
    RobotOptions robot;
    robot.lidar.beams = 31;
    return robot;
  }
  World world_ = must(make_world("corridor", {}, Random(1)));
  Route route_ = must(random_run(world_, {}, Random(2)));
};

TEST_F(Drive, ReportsInTimeOrderAtEachSensorsRate) {
  const Recording r = record(few_beams());
  EXPECT_TRUE(std::is_sorted(r.events.begin(), r.events.end(),
                             [](const auto& a, const auto& b) { return stamp_of(a) < stamp_of(b); }));
  const double seconds = r.truth.back().stamp - r.truth.front().stamp;
  EXPECT_NEAR(static_cast<double>(r.all<OdometryReading>().size()), 50 * seconds, 2);
  EXPECT_NEAR(static_cast<double>(r.all<FieldReading>().size()), 100 * seconds, 3);
  EXPECT_NEAR(static_cast<double>(r.all<LaserScan>().size()), 40 * seconds, 2);
  EXPECT_TRUE(r.all<ImuReading>().empty());
  EXPECT_TRUE(r.all<PoseReading>().empty()) << "the truth is no event";
}

TEST_F(Drive, IsTheSameForTheSameSeed) {
  const Recording a = record(few_beams()), b = record(few_beams()), other = record(few_beams(), {}, 4);
  ASSERT_EQ(a.events.size(), b.events.size());
  const auto fields_a = a.all<FieldReading>(), fields_b = b.all<FieldReading>();
  for (std::size_t i = 0; i < fields_a.size(); ++i)
    EXPECT_EQ(fields_a[i].sensor_field_uT, fields_b[i].sensor_field_uT);
  const auto scans_a = a.all<LaserScan>(), scans_b = b.all<LaserScan>();
  for (std::size_t i = 0; i < scans_a.size(); ++i) EXPECT_EQ(scans_a[i].ranges_m, scans_b[i].ranges_m);
  EXPECT_NE(fields_a[0].sensor_field_uT, other.all<FieldReading>()[0].sensor_field_uT);
}

TEST_F(Drive, LeavesTheOtherSensorsAsTheyAreWhenOneIsOff) {
  RobotOptions blind = few_beams(), ahead = few_beams();
  blind.lidar.rate_hz = 0.0;
  ahead.imu.rate_hz = 100.0;
  const auto full = record(few_beams()).all<FieldReading>();
  for (const RobotOptions& robot : {blind, ahead}) {
    const auto fields = record(robot).all<FieldReading>();
    ASSERT_EQ(fields.size(), full.size());
    for (std::size_t i = 0; i < fields.size(); ++i)
      EXPECT_EQ(fields[i].sensor_field_uT, full[i].sensor_field_uT);
  }
  EXPECT_TRUE(record(blind).all<LaserScan>().empty());
}

TEST_F(Drive, MeasuresTheFieldWhereTheMagnetometerIsAndAsItLies) {
  RobotOptions robot = few_beams();
  robot.lidar.rate_hz = 0.0;
  robot.magnetometer.noise_uT = robot.magnetometer.bias_sigma_uT = 0.0;
  robot.magnetometer.rate_hz = robot.odometry.rate_hz;
  robot.rig = tilted_rig({0.3, -0.2, 1.0});
  robot.rig.base_T_magnetometer.translation() = Vector3d(0.1, -0.2, 0.8);
  const Recording r = record(robot);
  const auto readings = r.all<FieldReading>();
  ASSERT_EQ(readings.size(), r.truth.size());
  for (std::size_t i = 0; i < readings.size(); i += 5) {
    const Eigen::Isometry3d map_T_sensor =
        to_isometry3(r.truth[i].map_T_base) * robot.rig.base_T_magnetometer;
    EXPECT_NEAR(
        (map_T_sensor.linear() * readings[i].sensor_field_uT - world_.field_uT(map_T_sensor.translation()))
            .norm(),
        0.0, 1e-9);
  }
}

TEST_F(Drive, TakesTheFieldFromElsewhereIfGiven) {
  RobotOptions robot = few_beams();
  robot.lidar.rate_hz = 0.0;
  robot.magnetometer.noise_uT = robot.magnetometer.bias_sigma_uT = 0.0;
  const auto readings = record(robot, [](const Pose2& pose, const Vector3d& at) {
                          EXPECT_NEAR(at.x(), pose.x, 1e-12);
                          return Vector3d(0, 0, -at.z());
                        }).all<FieldReading>();
  for (const FieldReading& reading : readings)
    EXPECT_NEAR((reading.sensor_field_uT - Vector3d(0, 0, -0.7)).norm(), 0.0, 1e-12);
}

TEST_F(Drive, ReportsTheTrueTurnRatesWhereAGyroscopeIsOn) {
  RobotOptions robot = few_beams();
  robot.lidar.rate_hz = 0.0;
  robot.imu = {100.0, 0.0, 0.0};
  const Recording r = record(robot);
  double turned = 0.0;
  for (const ImuReading& reading : r.all<ImuReading>()) turned += 0.01 * reading.angular_velocity_rad_s.z();
  EXPECT_NEAR(angle_between(turned, r.truth.back().map_T_base.yaw - r.truth.front().map_T_base.yaw), 0.0,
              0.02);
}

TEST_F(Drive, KeepsItsOdometryInTheClassOfItsOptions) {
  RobotOptions robot = few_beams();
  robot.lidar.rate_hz = robot.magnetometer.rate_hz = 0.0;
  double scale_square = 0.0, yaw_square = 0.0;
  constexpr int kRuns = 80;
  for (int i = 0; i < kRuns; ++i) {
    const Recording r = record(robot, {}, 100 + static_cast<std::uint64_t>(i));
    const auto odometry = r.all<OdometryReading>();
    double counted = 0.0, driven = 0.0;
    for (std::size_t k = 1; k < odometry.size(); ++k) {
      counted += distance(odometry[k - 1].odom_T_base, odometry[k].odom_T_base);
      driven += distance(r.truth[k - 1].map_T_base, r.truth[k].map_T_base);
    }
    const double yaw_error =
        angle_between(between(r.truth.front().map_T_base, r.truth.back().map_T_base).yaw,
                      between(odometry.front().odom_T_base, odometry.back().odom_T_base).yaw);
    scale_square += std::pow(counted / driven - 1.0, 2);
    yaw_square += std::pow(yaw_error / driven, 2);
  }
  EXPECT_NEAR(std::sqrt(scale_square / kRuns), 0.03, 0.01);
  EXPECT_NEAR(degrees(std::sqrt(yaw_square / kRuns)), 1.1, 0.4);
}

}  // namespace
}  // namespace mstsl::sim
