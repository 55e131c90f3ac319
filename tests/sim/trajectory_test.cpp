#include "mstsl/sim/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/sim/segment.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;

const Route kCorner{radians(30), {{0, 0}, {5, 0}, {8, 0.8}, {12, 0.8}, {12, 6}, {6, 6}}};

double largest_step(const Trajectory& trajectory) {
  double largest = 0.0;
  for (std::size_t i = 1; i < trajectory.poses.size(); ++i)
    largest = std::max(largest, distance(trajectory.poses[i - 1], trajectory.poses[i]));
  return largest;
}

TEST(Follow, KeepsToTheRouteAndArrives) {
  MotionOptions motion;
  const Trajectory t = follow(kCorner, motion, {}, Random(1));
  const auto legs = polyline(kCorner.waypoints_m, false);
  for (const Pose2& pose : t.poses) {
    double away = 1e9;
    for (const Segment& leg : legs) away = std::min(away, distance(pose.position(), leg));
    EXPECT_LT(away, 0.3);
  }
  EXPECT_NEAR((t.poses.front().position() - kCorner.waypoints_m.front()).norm(), 0.0, 1e-12);
  EXPECT_LT((t.poses.back().position() - kCorner.waypoints_m.back()).norm(), 0.2);
  EXPECT_NEAR(length(t), length(kCorner), 0.03 * length(kCorner));
}

TEST(Follow, ArrivesHoweverItWandersAndCutsCorners) {
  // Four cut corners: what was driven falls behind what was gained, until the point ahead was underfoot.
  const Route loop{0.0,
                   {{-9.85, 11.05},
                    {-9.35, 11.55},
                    {20.55, 11.55},
                    {23.65, 11.55},
                    {24.35, 10.85},
                    {24.35, -10.85},
                    {23.65, -11.55},
                    {11.85, -11.55},
                    {11.2, -11.05}}};
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Trajectory t = follow(loop, {}, {}, Random(seed));
    EXPECT_LT(length(t), 1.1 * length(loop));
    EXPECT_LT((t.poses.back().position() - loop.waypoints_m.back()).norm(), 0.3);
  }
}

TEST(Follow, RespectsTheLimits) {
  MotionOptions motion;
  const Trajectory t = follow(kCorner, motion, {}, Random(2));
  EXPECT_LE(largest_step(t), motion.speed_m_s * t.step_s + 1e-9);
  double speed = 0.0;
  for (std::size_t i = 1; i < t.poses.size(); ++i) {
    const double now = distance(t.poses[i - 1], t.poses[i]) / t.step_s;
    EXPECT_LE(now - speed, motion.acceleration_m_s2 * t.step_s + 1e-6);
    speed = now;
    EXPECT_LE(std::abs(angle_between(t.poses[i - 1].yaw, t.poses[i].yaw)) / t.step_s,
              motion.turn_rate_rad_s + 0.05);
  }
}

TEST(Follow, MovesAsADifferentialDriveCan) {
  const Trajectory t = follow(kCorner, {}, {}, Random(3));
  for (std::size_t i = 1; i < t.poses.size(); ++i) {
    const Pose2 step = between(t.poses[i - 1], t.poses[i]);
    EXPECT_NEAR(step.y * std::cos(0.5 * step.yaw) - step.x * std::sin(0.5 * step.yaw), 0.0, 1e-9)
        << "no wheel slides sideways";
    EXPECT_GE(step.x, -1e-9) << "it drives forwards";
  }
}

TEST(Follow, TurnsFirstByTheCommandedAngle) {
  MotionOptions motion;
  motion.initial_turn_rad = radians(-40);
  const Trajectory t = follow(kCorner, motion, {}, Random(4));
  EXPECT_EQ(t.at(0.99).yaw, kCorner.start_yaw_rad) << "stands still before";
  const double turned_s = motion.standstill_s + 1.6;
  EXPECT_NEAR(t.at(turned_s).yaw, kCorner.start_yaw_rad + motion.initial_turn_rad, 1e-6);
  EXPECT_NEAR((t.at(turned_s).position() - kCorner.waypoints_m[0]).norm(), 0.0, 1e-12) << "turns in place";
}

TEST(Follow, StandsAtAPointWithoutALeg) {
  const Trajectory t = follow({0.3, {{1, 2}}}, {}, {}, Random(1));
  ASSERT_FALSE(t.poses.empty());
  EXPECT_EQ(t.poses.back().position(), Vector2d(1, 2));
  EXPECT_TRUE(follow({0.3, {}}, {}, {}, Random(1)).poses.empty());
}

TEST(Follow, WandersAsItsOptionsSay) {
  MotionOptions motion;
  motion.wander_m = 0.05;
  const Route straight{0.0, {{0, 0}, {2000, 0}}};
  double square = 0.0;
  const Trajectory t = follow(straight, motion, {}, Random(5));
  for (const Pose2& pose : t.poses) square += pose.y * pose.y;
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(t.poses.size())), 0.05, 0.012);
}

TEST(AlongPoints, PassesEveryPointWithTheHeadingOfThePath) {
  std::vector<Vector2d> points;
  for (double a = 0; a < 3.0; a += 0.02) points.emplace_back(5 * std::cos(a), 5 * std::sin(a));
  const Trajectory t = along_points(points, {}, 0.4, Stamp::from_seconds(5));
  EXPECT_NEAR(length(t), 5 * 2.98, 0.05);
  const auto legs = polyline(points, false);
  for (std::size_t i = 0; i < t.poses.size(); ++i) {
    double away = 1e9;
    for (const Segment& leg : legs) away = std::min(away, distance(t.poses[i].position(), leg));
    EXPECT_LT(away, 1e-9);
    if (i > 50 && i + 50 < t.poses.size()) {
      const double tangent = std::atan2(t.poses[i].y, t.poses[i].x) + kPi / 2;
      EXPECT_NEAR(angle_between(t.poses[i].yaw, tangent), 0.0, 0.02);
    }
  }
}

TEST(AlongPoints, BearsRepeatedAndMissingPoints) {
  EXPECT_TRUE(along_points({}, {}, 0.4, {}).poses.empty());
  EXPECT_EQ(along_points({{1, 2}, {1, 2}}, {}, 0.4, {}).poses.size(), 1u);
  const Trajectory t = along_points({{0, 0}, {0, 0}, {1, 0}, {1, 0}}, {}, 0.4, {});
  EXPECT_NEAR(length(t), 1.0, 0.01);
  for (const Pose2& pose : t.poses) EXPECT_TRUE(pose.is_finite());
}

TEST(Trajectory, InterpolatesAndStaysAtItsEnds) {
  const Trajectory t{Stamp{}, 0.5, {{0, 0, radians(179)}, {1, 0, radians(-179)}}};
  EXPECT_NEAR(t.at(0.25).x, 0.5, 1e-12);
  EXPECT_NEAR(std::abs(t.at(0.25).yaw), kPi, 1e-9);
  EXPECT_EQ(t.at(-3).x, 0.0);
  EXPECT_EQ(t.at(99).x, 1.0);
}

}  // namespace
}  // namespace mstsl::sim
