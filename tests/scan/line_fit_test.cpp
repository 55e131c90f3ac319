#include "mstsl/scan/line_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "segment_world.hpp"

namespace mstsl {
namespace {

/// Two lines' directions differ by this, in [0, pi/2].
double line_angle_between(double a, double b) { return std::abs(std::remainder(a - b, kPi)); }

PointSet scan_points(const test::Segments& walls, const Pose2& pose, Random& random, double noise_m) {
  return points_in_base(test::scan_of(walls, pose, random, {.noise_m = noise_m}),
                        Eigen::Isometry3d::Identity());
}

TEST(FitLine, FindsTheLineThroughNoiseAndClutter) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const double angle = random.uniform(-kPi / 2, kPi / 2);
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle)),
        center(random.uniform(-3, 3), random.uniform(-3, 3));
    PointSet points;
    for (int i = 0; i < 200; ++i) {
      points.push_back(center + random.uniform(-3, 3) * along +
                       random.normal(0, 0.01) * Eigen::Vector2d(-along.y(), along.x()));
    }
    for (int i = 0; i < 300; ++i) points.emplace_back(random.uniform(-5, 5), random.uniform(-5, 5));
    const auto line = fit_line(points, {}, random);
    ASSERT_TRUE(line);
    EXPECT_LT(degrees(line_angle_between(line->angle_rad, angle)), 0.5);
    EXPECT_LT(line->distance_m(center), 0.02);
    EXPECT_GT(line->inliers, 120U);
    EXPECT_GT(line->length_m, 5.5);
    EXPECT_LT(line->residual_rms_m, 0.02);
  }
}

TEST(FitLine, GivesTheAngleWithinItsOwnSigma) {
  Random random(2);
  double squared = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    PointSet points;
    for (int i = 0; i < 100; ++i) points.emplace_back(0.05 * i, random.normal(0, 0.01));
    const auto line = fit_line(points, {.inlier_distance_m = 0.05}, random);
    ASSERT_TRUE(line);
    squared += std::pow(line->angle_rad / line->angle_sigma_rad, 2) / kTrials;
  }
  EXPECT_NEAR(squared, 1.0, 0.3);
}

/// The paper's office: alignment error 1.2 deg on average (Table I).
TEST(FitLine, AlignsTheRobotInACorridorFarBetterThanThePaper) {
  Random random(3);
  double sum_deg = 0, worst_deg = 0;
  constexpr int kTrials = 100;
  for (int trial = 0; trial < kTrials; ++trial) {
    test::Segments walls = test::bare_corridor();
    for (int person = 0; person < 3; ++person) {  // legs, as squares of 15 cm
      const double x = random.uniform(-4, 4), y = random.uniform(-0.8, 0.7);
      walls = test::joined(walls, test::rectangle(x, y, x + 0.15, y + 0.15));
    }
    const Pose2 pose{random.uniform(-10, 10) + 20, random.uniform(-0.5, 0.5), random.uniform(-kPi, kPi)};
    const auto line = fit_line(scan_points(walls, pose, random, 0.015), {}, random);
    ASSERT_TRUE(line);
    const double error_deg = degrees(std::abs(std::remainder(pose.yaw + turn_parallel_to(*line), kPi)));
    sum_deg += error_deg;
    worst_deg = std::max(worst_deg, error_deg);
  }
  EXPECT_LT(sum_deg / kTrials, 0.2);
  EXPECT_LT(worst_deg, 1.0);
}

TEST(FitLine, FindsNoneWhereThereIsNone) {
  Random random(4);
  EXPECT_FALSE(fit_line({}, {}, random));
  EXPECT_FALSE(fit_line(PointSet(100, Eigen::Vector2d(1, 2)), {}, random));
  EXPECT_FALSE(fit_line(PointSet(100, Eigen::Vector2d(1, 2)), {.spacing_m = 0}, random));
  PointSet scattered;
  for (int i = 0; i < 300; ++i) scattered.emplace_back(random.uniform(-20, 20), random.uniform(-20, 20));
  EXPECT_FALSE(fit_line(scattered, {}, random));
  PointSet far(50, Eigen::Vector2d(std::numeric_limits<float>::max(), 0));
  EXPECT_FALSE(fit_line(far, {}, random));
}

TEST(FitLine, DependsOnItsRandomNumbersOnly) {
  Random random(5);
  const PointSet points = scan_points(test::room(), {0.5, 0.5, 0.3}, random, 0.01);
  Random one(7), two(7);
  const auto a = fit_line(points, {}, one), b = fit_line(points, {}, two);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->angle_rad, b->angle_rad);
}

TEST(FitLine, TurnsWithTheRobot) {
  Random random(6);
  const PointSet points = scan_points(test::room(), {0.5, 0.5, 0.3}, random, 0.01);
  for (double yaw = -3; yaw < 3; yaw += 0.37) {
    Random one(7), two(7);
    const auto still = fit_line(points, {}, one),
               turned = fit_line(transformed({0, 0, yaw}, points), {}, two);
    ASSERT_TRUE(still && turned);
    EXPECT_LT(line_angle_between(still->angle_rad + yaw, turned->angle_rad), 1e-6);
  }
}

TEST(TurnParallelTo, IsAtMostARightAngleAndMakesTheRobotParallel) {
  for (double yaw = -3.1; yaw < 3.1; yaw += 0.1) {
    PointSet points;  // a wall along x seen from a robot with this yaw
    for (int i = 0; i < 100; ++i)
      points.push_back(inverse(Pose2{1, 2, yaw}) * Eigen::Vector2d(0.05 * i, 3.5));
    Random random(1);
    const auto line = fit_line(points, {}, random);
    ASSERT_TRUE(line);
    const double parallel = turn_parallel_to(*line), square = turn_square_to(*line);
    EXPECT_LE(std::abs(parallel), kPi / 2 + 1e-12);
    EXPECT_LE(std::abs(square), kPi / 4 + 1e-12);
    EXPECT_NEAR(std::sin(yaw + parallel), 0, 1e-9);
    EXPECT_NEAR(std::sin(2 * (yaw + square)), 0, 1e-9);
  }
}

}  // namespace
}  // namespace mstsl
