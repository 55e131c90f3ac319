#include "mstsl/magnetic/turn_calibration.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

/// A robot with iron on it, that turns on the spot here and there and drives between.
struct IronRobot {
  Rig rig;
  Eigen::Vector3d hard_uT = Eigen::Vector3d::Zero();         ///< sensor axes
  Eigen::Matrix3d distortion = Eigen::Matrix3d::Identity();  ///< of the sensor's true field
  double noise_uT = 0.3;
  double heading_scale = 1.0;  ///< of the odometry
  double gradient_uT_m = 0.0;  ///< horizontally diverging, where the sensor sits off the axis

  /// Reads a field at a true heading.
  Eigen::Vector3d reading(const Eigen::Vector3d& map_field_uT, double heading_rad, Random& random) const {
    const Eigen::AngleAxisd map_R_base(heading_rad, Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d offset_m = map_R_base * rig.base_T_magnetometer.translation();
    const Eigen::Vector3d there_uT =
        map_field_uT + gradient_uT_m * Eigen::Vector3d(offset_m.x(), offset_m.y(), 0.0);
    Eigen::Vector3d sensor_uT =
        rig.base_T_magnetometer.linear().transpose() * (map_R_base.inverse() * there_uT);
    sensor_uT = distortion * sensor_uT + hard_uT;
    for (int c = 0; c < 3; ++c) sensor_uT(c) += random.normal(0, noise_uT);
    return sensor_uT;
  }
};

class TurningDrive {
 public:
  TurningDrive(const IronRobot& robot, Random& random)
      : robot_(robot), random_(random), calibrator_(robot.rig) {}

  TurnCalibrator& calibrator() { return calibrator_; }

  void turn(double angle_rad, const Eigen::Vector3d& map_field_uT) {
    const int steps = static_cast<int>(std::abs(angle_rad) / radians(2.0));
    for (int i = 0; i < steps; ++i) {
      heading_rad_ += angle_rad / steps;
      pose_ = Pose2{pose_.x, pose_.y, wrap_angle(robot_.heading_scale * heading_rad_)};
      tick(map_field_uT);
    }
  }

  void drive(double way_m) {
    for (double done = 0.0; done < way_m; done += 0.05) {
      pose_ = pose_ * Pose2{0.05, 0.0, 0.0};
      tick({25.0 + random_.normal(0, 5.0), 5.0, -40.0});
    }
  }

 private:
  void tick(const Eigen::Vector3d& map_field_uT) {
    const Stamp stamp = Stamp::from_seconds(time_s_ += 0.05);
    calibrator_.observe(OdometryReading{stamp, pose_});
    calibrator_.observe(FieldReading{stamp, robot_.reading(map_field_uT, heading_rad_, random_)});
  }

  IronRobot robot_;
  Random& random_;
  TurnCalibrator calibrator_;
  Pose2 pose_;
  double heading_rad_ = 0.3, time_s_ = 0.0;
};

Eigen::Matrix3d a_distortion() {
  Eigen::Matrix3d d;
  d << 1.08, 0.05, 0.0, 0.05, 0.94, 0.0, 0.0, 0.0, 1.0;
  return d / std::sqrt(d.topLeftCorner<2, 2>().determinant());
}

const std::vector<Eigen::Vector3d> kPlaces{{20, 3, -40}, {14, -9, -35}, {26, 10, -46}, {9, 12, -38}};

TEST(TurnCalibration, FindsHardAndSoftIronAndSaysHowWell) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Random random(seed);
    IronRobot robot;
    robot.hard_uT = {12.0, -7.0, 0.0};
    robot.distortion = a_distortion();
    robot.heading_scale = 1.05;  // wheel odometry's, which must not matter
    TurningDrive drive(robot, random);
    for (const Eigen::Vector3d& field : kPlaces) {
      drive.drive(3.0);
      drive.turn(2 * kPi, field);
    }
    const auto found = drive.calibrator().finish();
    ASSERT_TRUE(found.ok()) << found.error().message();
    EXPECT_EQ(found->turns, kPlaces.size());
    const Eigen::Vector3d off = found->calibration.hard_iron_uT - robot.hard_uT;
    EXPECT_LT(off.head<2>().norm(), 0.3) << "seed " << seed;
    for (int c = 0; c < 2; ++c) EXPECT_LT(std::abs(off(c)), 5 * found->hard_iron_sd_uT(c)) << "seed " << seed;
    // Up to a twist, undoing the distortion leaves nothing but a rotation.
    const Eigen::Matrix2d left = (found->calibration.soft_iron * robot.distortion).topLeftCorner<2, 2>();
    EXPECT_LT((left.transpose() * left - Eigen::Matrix2d::Identity()).norm(), 0.03) << "seed " << seed;
    EXPECT_GT(found->uncorrected_uT, 5.0);
    EXPECT_LT(found->corrected_uT, 0.5);
    EXPECT_TRUE(found->warnings.empty());
  }
}

TEST(TurnCalibration, IsGivenInTheAxesOfATiltedSensor) {
  Random random(7);
  IronRobot robot;
  robot.rig.base_T_magnetometer.linear() =
      (Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  const Eigen::Matrix3d base_R_sensor = robot.rig.base_T_magnetometer.linear();
  const Eigen::Vector3d base_hard_uT(6.0, 4.0, 0.0);
  robot.hard_uT = base_R_sensor.transpose() * base_hard_uT;
  TurningDrive drive(robot, random);
  for (const Eigen::Vector3d& field : kPlaces) {
    drive.drive(2.0);
    drive.turn(-2 * kPi, field);
  }
  const auto found = drive.calibrator().finish();
  ASSERT_TRUE(found.ok()) << found.error().message();
  EXPECT_LT((found->calibration.hard_iron_uT - robot.hard_uT).norm(), 0.2);
  EXPECT_LT((found->calibration.soft_iron - Eigen::Matrix3d::Identity()).norm(), 0.03);
  // Corrected, the horizontal strength no longer depends on the heading.
  robot.noise_uT = 0.0;
  const auto horizontal_uT = [&](double heading_rad) {
    return (base_R_sensor * found->calibration.apply(robot.reading(kPlaces[0], heading_rad, random)))
        .head<2>()
        .norm();
  };
  for (double heading_rad = 0.0; heading_rad < 6.0; heading_rad += 0.7)
    EXPECT_NEAR(horizontal_uT(heading_rad), kPlaces[0].head<2>().norm(), 0.3);
}

TEST(TurnCalibration, ALeaningSensorShowsInTheVertical) {
  Random random(8);
  IronRobot robot;
  robot.distortion =
      Eigen::AngleAxisd(radians(3.0), Eigen::Vector3d(1, 0.5, 0).normalized()).toRotationMatrix();
  TurningDrive drive(robot, random);
  drive.turn(4 * kPi, kPlaces[0]);
  const auto found = drive.calibrator().finish();
  ASSERT_TRUE(found.ok()) << found.error().message();
  robot.noise_uT = 0.0;
  const double up_uT = found->calibration.apply(robot.reading(kPlaces[0], 0.0, random)).z();
  for (double heading_rad = 0.0; heading_rad < 6.0; heading_rad += 0.7)
    EXPECT_NEAR(found->calibration.apply(robot.reading(kPlaces[0], heading_rad, random)).z(), up_uT, 0.2);
}

TEST(TurnCalibration, OffTheAxisOneTurnIsNotSureAndSaysSo) {
  Random random(9);
  IronRobot robot;
  robot.rig.base_T_magnetometer.translation() = Eigen::Vector3d(0.3, 0.0, 0.4);
  robot.gradient_uT_m = 5.0;
  TurningDrive drive(robot, random);
  drive.turn(2 * kPi, kPlaces[0]);
  const auto found = drive.calibrator().finish();
  ASSERT_TRUE(found.ok()) << found.error().message();
  // The diverging field looks just like hard iron: that is beyond telling, but not beyond saying.
  EXPECT_NEAR(found->calibration.hard_iron_uT.x(), 1.5, 0.3);
  EXPECT_GT(found->hard_iron_sd_uT.x(), 1.0);
  ASSERT_FALSE(found->warnings.empty());
  EXPECT_NE(found->warnings.front().find("axis of rotation"), std::string::npos);
}

TEST(TurnCalibration, ADriveWithoutATurnOnTheSpotIsRefused) {
  Random random(10);
  TurningDrive drive(IronRobot{}, random);
  drive.drive(5.0);
  drive.turn(radians(90), kPlaces[0]);
  drive.drive(5.0);
  const auto found = drive.calibrator().finish();
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().message().find("turn on the spot"), std::string::npos);
}

TEST(TurnCalibration, OdometryThatStartsAnewSplitsATurn) {
  Random random(11);
  TurningDrive drive(IronRobot{}, random);
  drive.turn(radians(180), kPlaces[0]);
  drive.calibrator().restart();
  drive.turn(radians(180), kPlaces[0]);
  EXPECT_FALSE(drive.calibrator().finish().ok());
}

TEST(TurnCalibration, ReadingsThatAreNoNumbersAreLeftOut) {
  Random random(12);
  TurningDrive drive(IronRobot{}, random);
  drive.turn(2 * kPi, kPlaces[0]);
  drive.calibrator().observe(FieldReading{Stamp::from_seconds(1.0), Eigen::Vector3d::Constant(std::nan(""))});
  const auto found = drive.calibrator().finish();
  ASSERT_TRUE(found.ok());
  EXPECT_TRUE(found->calibration.hard_iron_uT.allFinite());
}

TEST(TurnCalibration, AVerticalFieldShowsNothing) {
  Random random(13);
  TurningDrive drive(IronRobot{}, random);
  drive.turn(2 * kPi, {0.5, 0.0, -55.0});
  EXPECT_FALSE(drive.calibrator().finish().ok());
  TurnCalibrator nothing{Rig{}};
  EXPECT_FALSE(nothing.finish().ok());
}

}  // namespace
}  // namespace mstsl
