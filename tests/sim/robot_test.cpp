#include "mstsl/sim/robot.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector3d;

OdometryOptions perfect_wheels() {
  OdometryOptions options;
  options.scale_sigma = options.drift_sigma_rad_per_m = options.noise_m_per_sqrt_m = options.slips_per_m =
      0.0;
  return options;
}

Pose2 drive_straight(const OdometryOptions& options, std::uint64_t seed, double metres) {
  WheelOdometry odometry(options, Random(seed));
  Pose2 pose;
  for (int i = 0; i < static_cast<int>(metres / 0.01 + 0.5); ++i) pose = odometry.advance({0.01, 0, 0});
  return pose;
}

TEST(WheelOdometry, IsExactWithoutErrors) {
  WheelOdometry odometry(perfect_wheels(), Random(1));
  Random random(2);
  Pose2 truth, counted;
  for (int i = 0; i < 500; ++i) {
    const double arc = random.uniform(-0.05, 0.05), turn = random.uniform(-0.3, 0.3);
    const double chord = std::abs(turn) < 1e-9 ? arc : arc * std::sin(0.5 * turn) / (0.5 * turn);
    const Pose2 motion{chord * std::cos(0.5 * turn), chord * std::sin(0.5 * turn), turn};
    truth = truth * motion;
    counted = odometry.advance(motion);
  }
  EXPECT_NEAR(distance(truth, counted), 0.0, 1e-9);
  EXPECT_NEAR(angle_between(truth.yaw, counted.yaw), 0.0, 1e-9);
}

TEST(WheelOdometry, HasTheScaleErrorOfItsOptions) {
  OdometryOptions options = perfect_wheels();
  options.scale_sigma = 0.03;
  double square = 0.0;
  constexpr int kRuns = 1500;
  for (int i = 0; i < kRuns; ++i) square += std::pow(drive_straight(options, i, 1.0).x - 1.0, 2);
  EXPECT_NEAR(std::sqrt(square / kRuns), 0.03, 0.002);
}

TEST(WheelOdometry, DriftsAsItsOptionsSay) {
  OdometryOptions options = perfect_wheels();
  options.drift_sigma_rad_per_m = radians(1.0);
  double square = 0.0;
  constexpr int kRuns = 1500;
  for (int i = 0; i < kRuns; ++i) square += std::pow(drive_straight(options, i, 3.0).yaw / 3.0, 2);
  EXPECT_NEAR(std::sqrt(square / kRuns), radians(1.0), radians(0.07));
}

TEST(WheelOdometry, GathersNoiseWithTheSquareRootOfTheWay) {
  OdometryOptions options = perfect_wheels();
  options.noise_m_per_sqrt_m = 0.01;
  for (const double metres : {1.0, 4.0}) {
    double length_square = 0.0, yaw_square = 0.0;
    constexpr int kRuns = 800;
    for (int i = 0; i < kRuns; ++i) {
      const Pose2 pose = drive_straight(options, i, metres);
      length_square += std::pow(pose.x - metres, 2);
      yaw_square += pose.yaw * pose.yaw;
    }
    EXPECT_NEAR(std::sqrt(yaw_square / kRuns), 0.01 * std::sqrt(2.0 * metres) / options.wheel_base_m,
                0.004 * std::sqrt(metres));
    EXPECT_NEAR(std::sqrt(length_square / kRuns), 0.01 * std::sqrt(metres / 2.0), 0.0015 * std::sqrt(metres));
  }
}

TEST(WheelOdometry, SlipsNowAndThen) {
  OdometryOptions options = perfect_wheels();
  options.slips_per_m = 0.1;
  options.slip_m = 0.02;
  int slipped = 0;
  double extra = 0.0;
  constexpr int kRuns = 800;
  for (int i = 0; i < kRuns; ++i) {
    const Pose2 pose = drive_straight(options, i, 2.0);
    slipped += pose.yaw != 0.0;
    extra += std::abs(pose.yaw) * options.wheel_base_m;
  }
  EXPECT_NEAR(static_cast<double>(slipped) / kRuns, 1.0 - std::exp(-0.2), 0.04);
  EXPECT_GT(extra / slipped, 0.01);
}

TEST(WheelOdometry, FollowsAWalkersSidewaysSteps) {
  WheelOdometry odometry(perfect_wheels(), Random(1));
  Pose2 counted;
  for (int i = 0; i < 100; ++i) counted = odometry.advance({0.01, 0.003, 0.0});
  EXPECT_NEAR(counted.y, 0.3, 1e-9);
}

TEST(Magnetometer, HasTheBiasAndNoiseOfItsOptions) {
  MagnetometerOptions options;
  options.bias_sigma_uT = 0.3;
  options.noise_uT = 0.1;
  double bias_square = 0.0, noise_square = 0.0;
  constexpr int kRuns = 600, kReadings = 20;
  const Vector3d field(10, 20, -40);
  for (int run = 0; run < kRuns; ++run) {
    Magnetometer magnetometer(options, Random(run));
    bias_square += magnetometer.bias_uT().squaredNorm() / 3.0;
    for (int i = 0; i < kReadings; ++i)
      noise_square +=
          (magnetometer.read(field, 0, 0, 0.01) - field - magnetometer.bias_uT()).squaredNorm() / 3.0;
  }
  EXPECT_NEAR(std::sqrt(bias_square / kRuns), 0.3, 0.02);
  EXPECT_NEAR(std::sqrt(noise_square / kRuns / kReadings), 0.1, 0.005);
}

TEST(Magnetometer, FeelsTheMotorsInProportionToTheWheels) {
  MagnetometerOptions options;
  options.noise_uT = options.bias_sigma_uT = 0.0;
  options.motor_uT_per_m_s = 4.0;
  Magnetometer magnetometer(options, Random(3));
  const Vector3d one = magnetometer.read(Vector3d::Zero(), 0.5, 0, 0.01),
                 two = magnetometer.read(Vector3d::Zero(), 1.0, 0, 0.01);
  EXPECT_NEAR(two.norm(), 4.0, 1e-9);
  EXPECT_NEAR((two - 2 * one).norm(), 0.0, 1e-12);
  EXPECT_EQ(magnetometer.read(Vector3d::Zero(), 0, 0, 0.01), Vector3d::Zero());
}

TEST(Magnetometer, DriftsAsARandomWalk) {
  MagnetometerOptions options;
  options.noise_uT = options.bias_sigma_uT = 0.0;
  options.bias_walk_uT_per_sqrt_s = 0.05;
  double square = 0.0;
  constexpr int kRuns = 300;
  for (int run = 0; run < kRuns; ++run) {
    Magnetometer magnetometer(options, Random(run));
    for (int i = 0; i < 400; ++i) magnetometer.read(Vector3d::Zero(), 0, 0, 0.01);
    square += magnetometer.bias_uT().squaredNorm() / 3.0;
  }
  EXPECT_NEAR(std::sqrt(square / kRuns), 0.05 * std::sqrt(4.0), 0.01);
}

TEST(Rig, TurnsTheTiltedMagnetometerByRollPitchYaw) {
  const Rig rig = tilted_rig({0.0, 0.0, radians(90)});
  EXPECT_NEAR((rig.base_T_magnetometer.linear() * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 0.0, 1e-12);
  EXPECT_NEAR(
      (tilted_rig({radians(90), 0, 0}).base_T_magnetometer.linear() * Vector3d::UnitY() - Vector3d::UnitZ())
          .norm(),
      0.0, 1e-12);
  EXPECT_NEAR(
      (tilted_rig({0, radians(90), 0}).base_T_magnetometer.linear() * Vector3d::UnitX() + Vector3d::UnitZ())
          .norm(),
      0.0, 1e-12);
}

}  // namespace
}  // namespace mstsl::sim
