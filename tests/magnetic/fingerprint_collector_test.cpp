#include "mstsl/magnetic/fingerprint_collector.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

/// A field that changes from place to place, known everywhere.
Eigen::Vector3d field_at(const Eigen::Vector2d& p) {
  return {20 + 3 * std::sin(p.x()), 5 * std::cos(0.7 * p.y()), -40 + p.x() * p.y()};
}

Rig tilted_rig() {
  Rig rig;
  rig.base_T_magnetometer.linear() =
      (Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(kPi + 0.2, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  rig.base_T_magnetometer.translation() << 0.3, -0.2, 0.6;
  return rig;
}

FieldReading read_at(const Rig& rig, Stamp stamp, const Pose2& map_T_base) {
  const Eigen::Isometry3d map_T_sensor = to_isometry3(map_T_base) * rig.base_T_magnetometer;
  return {stamp, map_T_sensor.linear().transpose() * field_at(map_T_sensor.translation().head<2>())};
}

/// Drives `pose_at` for a while: poses at 20 Hz, readings at 100 Hz between them.
void drive(FingerprintCollector& collector, const Rig& rig, double from_s, double to_s,
           const std::function<Pose2(double)>& pose_at) {
  const int steps = static_cast<int>(std::lround((to_s - from_s) * 100));
  for (int i = 0; i <= steps; ++i) {
    const double t = from_s + 0.01 * i;
    if (i % 5 == 0) collector.observe(PoseReading{Stamp::from_seconds(t), pose_at(t)});
    collector.observe(read_at(rig, Stamp::from_seconds(t), pose_at(t)));
  }
}

Pose2 straight(double t) { return {0.5 * t, 1.0, 0.0}; }

TEST(FingerprintCollector, ATiltedMagnetometerOffTheAxisGivesTheFieldOfItsOwnPlace) {
  const Rig rig = tilted_rig();
  FingerprintCollector collector(rig);
  const auto curve = [](double t) {
    return Pose2{std::cos(0.3 * t), std::sin(0.3 * t), wrap_angle(0.3 * t + kPi / 2)};
  };
  drive(collector, rig, 0.0, 20.0, curve);
  const auto fingerprints = collector.finish();
  ASSERT_GT(fingerprints.size(), 80u);
  for (const Fingerprint& f : fingerprints)
    // 5 cm of travel within a field that bends: the mean of the readings is the field at the mean place to
    // second order.
    EXPECT_LT((f.field_uT - field_at(f.position_m)).norm(), 0.01);
  // The magnetometer, not the base, runs on a circle of this radius: sensor 0.3 m ahead, 0.2 m to the right
  // (outside).
  EXPECT_NEAR(fingerprints[10].position_m.norm(), std::hypot(1.2, 0.3), 1e-3);
}

TEST(FingerprintCollector, OneFingerprintPerFiveCentimetresOfTravel) {
  FingerprintCollector collector{Rig{}};
  drive(collector, {}, 0.0, 20.0, straight);  // 10 m
  const auto fingerprints = collector.finish();
  EXPECT_NEAR(static_cast<double>(fingerprints.size()), 200, 2);
  for (std::size_t i = 1; i + 1 < fingerprints.size(); ++i)
    EXPECT_NEAR((fingerprints[i].position_m - fingerprints[i - 1].position_m).norm(), 0.05, 0.0051);
}

TEST(FingerprintCollector, StandingStillIsOneFingerprint) {
  FingerprintCollector collector{Rig{}};
  drive(collector, {}, 0.0, 60.0, [](double) { return Pose2{2.0, 3.0, 0.5}; });
  const auto fingerprints = collector.finish();
  ASSERT_EQ(fingerprints.size(), 1u);
  EXPECT_NEAR(fingerprints[0].heading_rad, 0.5, 1e-9);
  EXPECT_LT((fingerprints[0].field_uT - field_at({2.0, 3.0})).norm(), 1e-9);
}

TEST(FingerprintCollector, TurningInPlaceKeepsHeadingsApart) {
  FingerprintCollector collector{Rig{}};
  drive(collector, {}, 0.0, 10.0, [](double t) { return Pose2{0, 0, wrap_angle(kPi / 5 * t)}; });
  EXPECT_GE(collector.finish().size(), 15u);
}

TEST(FingerprintCollector, HeadingsAcrossHalfATurnAreAveragedOnTheCircle) {
  FingerprintCollector collector{Rig{}};
  drive(collector, {}, 0.0, 0.3, [](double t) { return Pose2{0, 0, wrap_angle(kPi + (t - 0.15))}; });
  const auto fingerprints = collector.finish();
  ASSERT_EQ(fingerprints.size(), 1u);
  EXPECT_NEAR(std::abs(angle_between(kPi, fingerprints[0].heading_rad)), 0.0, 0.01);
}

TEST(FingerprintCollector, NothingIsInterpolatedAcrossAGapInThePoses) {
  FingerprintCollector collector{Rig{}};
  drive(collector, {}, 0.0, 2.0, straight);
  for (double t = 2.01; t < 5.0; t += 0.01)
    collector.observe(read_at({}, Stamp::from_seconds(t), straight(t)));
  drive(collector, {}, 5.0, 7.0, straight);
  for (const Fingerprint& f : collector.finish())
    EXPECT_TRUE(f.position_m.x() < 1.01 || f.position_m.x() > 2.49);
  EXPECT_GT(collector.report().in_pose_gap, 290u);
}

TEST(FingerprintCollector, AJumpOfThePoseIsNotDrivenThrough) {
  FingerprintCollector collector{Rig{}};
  drive(collector, {}, 0.0, 2.0, [](double t) { return t < 1.0 ? straight(t) : Pose2{50.0 + t, 1.0, 0.0}; });
  for (const Fingerprint& f : collector.finish())
    EXPECT_TRUE(f.position_m.x() < 1.0 || f.position_m.x() > 50.0);
  EXPECT_GT(collector.report().at_pose_jump, 0u);
}

TEST(FingerprintCollector, EveryReadingIsCountedOnce) {
  FingerprintCollector collector{Rig{}};
  collector.observe(read_at({}, Stamp::from_seconds(-1.0), {}));  // before any pose
  drive(collector, {}, 0.0, 1.0, straight);
  FieldReading bad = read_at({}, Stamp::from_seconds(1.01), straight(1.0));
  bad.sensor_field_uT.y() = std::numeric_limits<double>::quiet_NaN();
  collector.observe(bad);
  collector.observe(read_at({}, Stamp::from_seconds(0.5), straight(0.5)));  // late
  collector.observe(PoseReading{Stamp::from_seconds(1.05), {std::nan(""), 0, 0}});
  collector.observe(PoseReading{Stamp::from_seconds(0.2), straight(0.2)});
  collector.observe(read_at({}, Stamp::from_seconds(1.06), straight(1.06)));  // no pose after it
  collector.finish();
  const CollectionReport& r = collector.report();
  EXPECT_EQ(r.not_finite, 1u);
  EXPECT_EQ(r.out_of_order, 1u);
  EXPECT_EQ(r.bad_poses, 2u);
  EXPECT_EQ(r.without_pose, 3u);  // the first, and those after the last good pose
  EXPECT_EQ(r.readings,
            r.used + r.not_finite + r.out_of_order + r.without_pose + r.in_pose_gap + r.at_pose_jump);
}

TEST(FingerprintCollector, ASecondLogStartsAnewWithItsOwnSession) {
  FingerprintCollector collector{Rig{}};
  drive(collector, {}, 100.0, 102.0, straight);
  collector.start_session(tilted_rig());
  drive(collector, tilted_rig(), 0.0, 2.0, straight);  // its clock starts again
  const auto fingerprints = collector.finish();
  EXPECT_EQ(fingerprints.front().session, 0);
  EXPECT_EQ(fingerprints.back().session, 1);
  for (const Fingerprint& f : fingerprints) EXPECT_LT((f.field_uT - field_at(f.position_m)).norm(), 0.01);
}

TEST(FingerprintCollector, NoReadingsGiveNoFingerprints) {
  FingerprintCollector collector{Rig{}};
  EXPECT_TRUE(collector.finish().empty());
}

}  // namespace
}  // namespace mstsl
