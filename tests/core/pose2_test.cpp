#include "mstsl/core/pose2.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

Pose2 any_pose(Random& random) {
  return {random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-kPi, kPi)};
}

void expect_same(const Pose2& a, const Pose2& b) {
  EXPECT_NEAR(distance(a, b), 0.0, 1e-10);
  EXPECT_NEAR(angle_between(a.yaw, b.yaw), 0.0, 1e-12);
}

TEST(Pose2, FormsAGroup) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Pose2 a = any_pose(random), b = any_pose(random), c = any_pose(random);
    expect_same((a * b) * c, a * (b * c));
    expect_same(a * inverse(a), Pose2{});
    expect_same(inverse(a) * a, Pose2{});
    expect_same(a * Pose2{}, a);
    expect_same(a * between(a, b), b);
  }
}

TEST(Pose2, ActsOnPointsAsItComposes) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Pose2 a = any_pose(random), b = any_pose(random);
    const Eigen::Vector2d p(random.uniform(-9, 9), random.uniform(-9, 9));
    EXPECT_NEAR(((a * b) * p - a * (b * p)).norm(), 0.0, 1e-10);
  }
}

TEST(Pose2, AgreesWithMotionsInSpace) {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Pose2 a = any_pose(random), b = any_pose(random);
    expect_same(to_pose2(to_isometry3(a) * to_isometry3(b)), a * b);
  }
}

TEST(Pose2, InterpolatesTheShortWayRound) {
  const Pose2 half = interpolate({0, 0, radians(170)}, {2, 4, radians(-170)}, 0.5);
  expect_same(half, {1, 2, kPi});
}

TEST(Pose2, TellsAPoseThatIsNone) {
  EXPECT_TRUE((Pose2{1, 2, 3}.is_finite()));
  EXPECT_FALSE((Pose2{1, std::numeric_limits<double>::quiet_NaN(), 3}.is_finite()));
}

}  // namespace
}  // namespace mstsl
