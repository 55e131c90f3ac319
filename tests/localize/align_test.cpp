#include "mstsl/localize/align.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

const Eigen::Vector3d kField(18.0, 7.0, -40.0);  // in the building's axes

/// The end points, in the base frame, of a long wall along the building's x axis, 1 m to its south.
PointSet wall_seen_from(const Pose2& building_T_base) {
  PointSet points;
  for (double x = -6.0; x <= 6.0; x += 0.05)
    points.push_back(inverse(building_T_base) * Eigen::Vector2d(x, -1.0));
  return points;
}

/// A robot with perfect odometry (but for a share of its turns) that starts at `yaw` to the building.
struct Robot {
  FirstReading reading{AlignOptions{}};
  Random random{1};
  Pose2 building_T_base;
  Pose2 track_T_base{5.0, 5.0, 1.0};
  double odometry_turn_error = 0.0;
  int tick = 0;

  explicit Robot(double yaw_rad) : building_T_base{0, 0, yaw_rad} {}

  void go(int ticks, const Pose2& step, double extra_field_uT = 0.0) {
    for (int i = 0; i < ticks; ++i, ++tick) {
      building_T_base = building_T_base * step;
      track_T_base = track_T_base * Pose2{step.x, step.y, step.yaw * (1.0 + odometry_turn_error)};
      const Stamp stamp = Stamp::from_seconds(0.02 * tick);
      if (tick % 5 == 0) reading.observe_scan(stamp, wall_seen_from(building_T_base), track_T_base, random);
      const Eigen::Vector3d base_field =
          Eigen::AngleAxisd(-building_T_base.yaw, Eigen::Vector3d::UnitZ()) * kField +
          Eigen::Vector3d::Constant(extra_field_uT);
      reading.observe_field(stamp, base_field, track_T_base);
    }
  }
};

TEST(FirstReading, OfARobotThatTurnsByBetaNeedsNoMoreTurning) {
  Robot robot(radians(-35));
  robot.go(50, {});
  robot.go(50, {0, 0, radians(35.0 / 50)}, 9.0);
  robot.go(50, {});
  EXPECT_FALSE(robot.reading.take()) << "it may still be standing for a second turn";
  robot.go(10, {0.01, 0, 0}, 9.0);
  const auto aligned = robot.reading.take();
  ASSERT_TRUE(aligned);
  EXPECT_NEAR(degrees(aligned->beta_rad), 35.0, 0.2);
  EXPECT_NEAR(degrees(aligned->aligned_yaw_rad), 0.0, 0.2);
  EXPECT_NEAR((aligned->field_uT - kField).norm(), 0.0, 0.6) << "readings of the turn must not count";
  EXPECT_GE(aligned->readings, 50u);
}

TEST(FirstReading, OfARobotThatDrivesOffIsTurnedByTheWholeOfBeta) {
  Robot robot(radians(-35));
  robot.go(50, {});
  robot.go(10, {0.01, 0, 0});
  const auto aligned = robot.reading.take();
  ASSERT_TRUE(aligned);
  EXPECT_NEAR(degrees(aligned->aligned_yaw_rad), -35.0, 0.2);
  EXPECT_NEAR((aligned->field_uT - kField).norm(), 0.0, 1e-1);
}

TEST(FirstReading, MakesUpForWheelsThatSlipWhileTurning) {
  Robot robot(radians(-40));
  robot.odometry_turn_error = 0.2;
  robot.go(50, {});
  robot.go(50, {0, 0, radians(40.0 / 50)});
  robot.go(50, {});
  robot.go(10, {0.01, 0, 0});
  EXPECT_NEAR((robot.reading.take()->field_uT - kField).norm(), 0.0, 1e-1);
}

TEST(FirstReading, OfARobotThatOnlyStandsIsTakenWhenPatienceEnds) {
  Robot robot(radians(10));
  robot.go(100, {});
  EXPECT_FALSE(robot.reading.take());
  robot.go(100, {});
  ASSERT_TRUE(robot.reading.take());
  EXPECT_NEAR((robot.reading.take()->field_uT - kField).norm(), 0.0, 1e-1);
}

TEST(FirstReading, OfARobotThatIsOnItsWayComesFromWhereItIs) {
  Robot robot(radians(15));
  robot.go(100, {0.01, 0, 0});
  const auto aligned = robot.reading.take();
  ASSERT_TRUE(aligned);
  EXPECT_NEAR((aligned->field_uT - kField).norm(), 0.0, 1e-1);
  EXPECT_LT(distance(aligned->track_T_base, robot.track_T_base), 1.1);
}

TEST(FirstReading, NeedsBothALineAndAField) {
  Random random(1);
  FirstReading no_line{AlignOptions{}}, no_field{AlignOptions{}};
  for (int i = 0; i < 300; ++i) {
    const Stamp stamp = Stamp::from_seconds(0.02 * i);
    const Pose2 pose{0.01 * i, 0, 0};
    no_line.observe_field(stamp, kField, pose);
    no_line.observe_scan(stamp, {{1, 1}, {2, 5}, {-3, 0}}, pose, random);
    no_field.observe_scan(stamp, wall_seen_from(pose), pose, random);
  }
  EXPECT_FALSE(no_line.take());
  EXPECT_TRUE(no_line.has_field());
  EXPECT_FALSE(no_field.take());
  EXPECT_TRUE(no_field.has_line());
}

}  // namespace
}  // namespace mstsl
