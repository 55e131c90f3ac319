#include "mstsl/core/trajectory.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

Trajectory two_poses() {
  Trajectory trajectory;
  trajectory.add(Stamp::from_seconds(1.0), {0.0, 0.0, radians(170)});
  trajectory.add(Stamp::from_seconds(2.0), {2.0, 4.0, radians(-170)});
  return trajectory;
}

TEST(Trajectory, AnswersBetweenItsPosesTheShortWayRound) {
  const auto pose = two_poses().at(Stamp::from_seconds(1.5), 1.0);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->x, 1.0, 1e-9);
  EXPECT_NEAR(pose->y, 2.0, 1e-9);
  EXPECT_NEAR(std::abs(pose->yaw), kPi, 1e-9);
}

TEST(Trajectory, AnswersAtItsEndsAndNotBeyond) {
  EXPECT_TRUE(two_poses().at(Stamp::from_seconds(1.0), 1.0));
  EXPECT_TRUE(two_poses().at(Stamp::from_seconds(2.0), 1.0));
  EXPECT_FALSE(two_poses().at(Stamp::from_seconds(0.999), 1.0));
  EXPECT_FALSE(two_poses().at(Stamp::from_seconds(2.001), 1.0));
  EXPECT_FALSE(Trajectory().at(Stamp{}, 1.0));
}

TEST(Trajectory, SaysNothingInsideALongGap) { EXPECT_FALSE(two_poses().at(Stamp::from_seconds(1.5), 0.5)); }

TEST(Trajectory, RefusesWhatIsNotLaterOrNotFinite) {
  Trajectory trajectory = two_poses();
  EXPECT_FALSE(trajectory.add(Stamp::from_seconds(2.0), {}));
  EXPECT_FALSE(trajectory.add(Stamp::from_seconds(3.0), {std::numeric_limits<double>::quiet_NaN(), 0, 0}));
  EXPECT_EQ(trajectory.size(), 2u);
}

TEST(Trajectory, ForgettingKeepsTheAnswerAtThatTime) {
  Trajectory trajectory = two_poses();
  trajectory.add(Stamp::from_seconds(3.0), {3.0, 0.0, 0.0});
  const auto before = trajectory.at(Stamp::from_seconds(2.5), 1.0);
  trajectory.forget_before(Stamp::from_seconds(2.5));
  EXPECT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory.at(Stamp::from_seconds(2.5), 1.0)->x, before->x);
  EXPECT_FALSE(trajectory.at(Stamp::from_seconds(1.5), 1.0));
}

}  // namespace
}  // namespace mstsl
