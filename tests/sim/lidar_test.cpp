#include "mstsl/sim/lidar.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/sim/robot.hpp"

#include "test_support.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;

const Eigen::Isometry3d kCentred = Eigen::Isometry3d::Identity();

World room(const Vector2d& size_m) {
  WorldPlan plan;
  plan.name = "room";
  plan.footprint_m = Eigen::AlignedBox2d(-0.5 * size_m, 0.5 * size_m);
  plan.walls = box({}, size_m);
  plan.lanes = {{{{-0.25 * size_m.x(), 0}, {0.25 * size_m.x(), 0}}, 1.0}};
  return World(plan);
}

Trajectory standing(const Pose2& pose) { return {Stamp::from_seconds(100.0), 0.01, {pose}}; }

LidarOptions exact() {
  LidarOptions options;
  options.near_noise_m = options.far_noise_m = options.dropout = 0.0;
  options.detection_range_m = 1e6;
  return options;
}

TEST(Lidar, IsAUtm30Lx) {
  Random random(1);
  const LaserScan s = scan(room({8, 4}), {}, standing({}), 0.5, kCentred, {}, random);
  EXPECT_EQ(s.ranges_m.size(), 1081u);
  EXPECT_NEAR(s.angle_min_rad, radians(-135.0), 1e-12);
  EXPECT_NEAR(s.angle_increment_rad, radians(0.25), 1e-12);
  EXPECT_NEAR(s.time_increment_s * 1440, 0.025, 1e-9) << "a turn takes 25 ms";
  EXPECT_EQ(s.stamp, Stamp::from_seconds(100.5));
  EXPECT_EQ(s.range_max_m, 30.0);
}

TEST(Lidar, MeasuresTheDistanceToTheWalls) {
  Random random(1);
  const Pose2 pose{1.0, 0.5, 0.7};
  const World world = room({8, 4});
  const LaserScan s = scan(world, {}, standing(pose), 0.0, kCentred, exact(), random);
  for (std::size_t i = 0; i < s.ranges_m.size(); ++i) {
    const double angle = s.angle_min_rad + static_cast<double>(i) * s.angle_increment_rad;
    const Vector2d hit = pose * Vector2d(s.ranges_m[i] * std::cos(angle), s.ranges_m[i] * std::sin(angle));
    EXPECT_LT(world.surfaces().clearance(hit, 1.0), 0.00051) << "beam " << i;  // whole millimetres
  }
}

TEST(Lidar, HasTheDataSheetsNoise) {
  Random random(2);
  for (const auto& [distance_m, sigma_m] : {std::pair(4.0, 0.010), std::pair(20.0, 0.030)}) {
    LidarOptions ahead;
    ahead.beams = 1;
    ahead.field_of_view_rad = 0.0;
    ahead.dropout = 0.0;
    ahead.detection_range_m = 1e6;
    const World world = room({2 * distance_m, 2 * distance_m});
    double sum = 0.0, square = 0.0;
    constexpr int kScans = 4000;
    for (int i = 0; i < kScans; ++i) {
      const double error =
          scan(world, {}, standing({}), 0.0, kCentred, ahead, random).ranges_m.at(0) - distance_m;
      sum += error;
      square += error * error;
    }
    EXPECT_NEAR(sum / kScans, 0.0, 4 * sigma_m / std::sqrt(kScans));
    EXPECT_NEAR(std::sqrt(square / kScans), sigma_m, 0.05 * sigma_m);
  }
}

TEST(Lidar, LosesBeamsAtRandom) {
  Random random(3);
  LidarOptions options;
  options.dropout = 0.05;
  int lost = 0, all = 0;
  for (int i = 0; i < 20; ++i)
    for (const float range : scan(room({4, 4}), {}, standing({}), 0.0, kCentred, options, random).ranges_m)
      ++all, lost += std::isinf(range);
  EXPECT_NEAR(static_cast<double>(lost) / all, 0.05, 0.006);
}

TEST(Lidar, LosesGlancingBeamsOnLongWallsFirst) {
  Random random(4);
  const LaserScan s = scan(room({70, 2}), {}, standing({}), 0.0, kCentred, {}, random);
  const auto share_lost = [&](double from_deg, double to_deg) {
    double lost = 0, all = 0;
    for (std::size_t i = 0; i < s.ranges_m.size(); ++i) {
      const double angle =
          std::abs(degrees(s.angle_min_rad + static_cast<double>(i) * s.angle_increment_rad));
      if (angle < from_deg || angle > to_deg) continue;
      all += 1;
      lost += std::isinf(s.ranges_m[i]);
    }
    return lost / all;
  };
  EXPECT_GT(share_lost(1.9, 3.5), 0.8) << "16 to 30 m away at 2 to 3.5 deg";
  EXPECT_LT(share_lost(10, 90), 0.02);
}

TEST(Lidar, SeesNothingBeyondItsRange) {
  Random random(5);
  for (const float range : scan(room({100, 100}), {}, standing({}), 0.0, kCentred, exact(), random).ranges_m)
    EXPECT_TRUE(std::isinf(range));
}

TEST(Lidar, IsDistortedByTheRobotsMotionDuringTheSweep) {
  Random random(6);
  LidarOptions slow = exact();
  slow.sweep_s = 1.0;
  Trajectory moving{Stamp{}, 0.5, {{0, 0, 0}, {0.5, 0, 0}, {1.0, 0, 0}}};
  const World world = room({20, 20});
  const LaserScan s = scan(world, {}, moving, 0.0, kCentred, slow, random);
  EXPECT_NEAR(s.ranges_m[540], 10.0 - 0.5, 0.001);  // straight ahead, half way through
  EXPECT_NEAR(s.ranges_m[540 - 360], 10.0, 0.001);  // right
  EXPECT_NEAR(s.ranges_m[540 + 360], 10.0, 0.001);  // left
  const double before = s.ranges_m[540 - 180], after = s.ranges_m[540 + 180];  // 45 deg either side
  EXPECT_NEAR(std::sqrt(0.5) * before, 10.0 - 180.0 / 540.0, 0.001 + 1e-3);
  EXPECT_NEAR(std::sqrt(0.5) * after, 10.0 - 360.0 / 540.0 + 0.0, 0.4);
  EXPECT_LT(after, before);
}

TEST(Lidar, UsesItsMountingInFull) {
  Random random(7);
  const World world = room({10, 6});
  Eigen::Isometry3d flipped = Eigen::Isometry3d::Identity();
  flipped.translation() = Eigen::Vector3d(1.0, 0.5, 0.3);
  flipped.linear() = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const LaserScan s = scan(world, {}, standing({}), 0.0, flipped, exact(), random);
  EXPECT_NEAR(s.ranges_m[540], 4.0, 0.001);
  EXPECT_NEAR(s.ranges_m[540 + 360], 3.5, 0.001) << "upside down, left is right";
  EXPECT_NEAR(s.ranges_m[540 - 360], 2.5, 0.001);
}

TEST(People, WalkTheLanesAndAreSeen) {
  const World world = test::must(make_world("corridor", {}, Random(1)));
  PeopleOptions crowd;
  crowd.per_100m = 20.0;
  const People people(world, crowd, Random(2));
  const auto before = people.legs(0.0, {0, 0}, 1e3), after = people.legs(2.0, {0, 0}, 1e3);
  ASSERT_EQ(before.size(), after.size());
  ASSERT_GT(before.size(), 20u);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_GT(world.surfaces().clearance(before[i].center_m, 1.0), before[i].radius_m);
    EXPECT_LT((before[i].center_m - after[i].center_m).norm(), 2.0 * 1.3 * crowd.speed_m_s + 1.0);
  }
  Random random(3);
  const Pose2 pose = Pose2::from(before[0].center_m + Vector2d(0.0, 0.0), 0.0);
  const Pose2 near{pose.x - 1.0, pose.y, 0.0};
  const LaserScan empty = scan(world, {}, standing(near), 0.0, kCentred, exact(), random);
  const LaserScan crowded = scan(world, people, standing(near), 0.0, kCentred, exact(), random);
  EXPECT_LT(crowded.ranges_m[540], empty.ranges_m[540] - 0.1f);
}

TEST(People, StepAside) {
  const World world = test::must(make_world("corridor", {}, Random(1)));
  const People people(world, {100.0, 1.2, 0.06, 0.5}, Random(2));
  for (int i = 0; i < 50; ++i) {
    const Vector2d robot = point_along(world.lanes()[0].center, 0.02 * i);
    for (const Leg& leg : people.legs(0.5 * i, robot, 30.0))
      EXPECT_GT((leg.center_m - robot).norm(), 0.5 - 0.4);
  }
}

}  // namespace
}  // namespace mstsl::sim
