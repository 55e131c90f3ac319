#include "mstsl/scan/points.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "segment_world.hpp"

namespace mstsl {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

LaserScan scan_with(std::vector<float> ranges_m) {
  LaserScan scan;
  scan.angle_min_rad = -0.5;
  scan.angle_increment_rad = 0.25;
  scan.range_min_m = 0.1;
  scan.range_max_m = 30.0;
  scan.ranges_m = std::move(ranges_m);
  return scan;
}

Eigen::Isometry3d mounting(double x, double y, double z, double yaw, double pitch, double roll) {
  Eigen::Isometry3d base_T_laser = Eigen::Isometry3d::Identity();
  base_T_laser.translation() << x, y, z;
  base_T_laser.linear() =
      (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return base_T_laser;
}

TEST(PointsInBase, PutsEachBeamWhereItsAngleAndRangeSay) {
  const PointSet points =
      points_in_base(scan_with({1, 2, 3, 4, 5}), mounting(0.2, -0.1, 0.3, radians(90), 0, 0));
  ASSERT_EQ(points.size(), 5U);
  for (int i = 0; i < 5; ++i) {
    const double angle = radians(90) - 0.5 + 0.25 * i;
    EXPECT_NEAR(points[i].x(), 0.2 + (i + 1) * std::cos(angle), 1e-6);
    EXPECT_NEAR(points[i].y(), -0.1 + (i + 1) * std::sin(angle), 1e-6);
  }
}

TEST(PointsInBase, MirrorsALaserThatHangsUpsideDown) {
  const LaserScan scan = scan_with({1, 2, 3, 4, 5});
  const PointSet upright = points_in_base(scan, Eigen::Isometry3d::Identity());
  const PointSet hanging = points_in_base(scan, mounting(0, 0, 0, 0, 0, kPi));
  for (std::size_t i = 0; i < upright.size(); ++i) {
    EXPECT_NEAR((hanging[i] - Eigen::Vector2d(upright[i].x(), -upright[i].y())).norm(), 0, 1e-9);
  }
}

TEST(PointsInBase, SeesATiltedLasersPointsFromAbove) {
  const PointSet points = points_in_base(scan_with({1, 1, 2}), mounting(0, 0, 1, 0, radians(20), 0));
  EXPECT_NEAR(points[2].x(), 2 * std::cos(radians(20)), 1e-6);
  EXPECT_NEAR(points[2].y(), 0, 1e-6);
}

TEST(PointsInBase, DropsBeamsWithoutAReturn) {
  const auto inf = static_cast<float>(kInfinity), nan = static_cast<float>(kNaN);
  const PointSet points = points_in_base(scan_with({nan, inf, -inf, 0.05F, 30.5F, -1.0F, 0.0F, 30.0F}),
                                         Eigen::Isometry3d::Identity());
  ASSERT_EQ(points.size(), 1U);
  EXPECT_NEAR(points[0].norm(), 30.0, 1e-5);
}

TEST(PointsInBase, OfHostileScansAreFiniteOrNone) {
  EXPECT_TRUE(points_in_base(scan_with({}), Eigen::Isometry3d::Identity()).empty());
  EXPECT_TRUE(points_in_base(LaserScan{}, Eigen::Isometry3d::Identity()).empty());
  for (double LaserScan::*field : {&LaserScan::angle_min_rad, &LaserScan::angle_increment_rad,
                                   &LaserScan::range_min_m, &LaserScan::range_max_m}) {
    for (const double bad : {kNaN, kInfinity, -kInfinity, 1e308}) {
      LaserScan scan = scan_with({1, 2, std::numeric_limits<float>::max()});
      scan.*field = bad;
      for (const Eigen::Vector2d& p : points_in_base(scan, Eigen::Isometry3d::Identity(), {0.1, 0, 0.1}))
        EXPECT_TRUE(p.allFinite());
      for (const Eigen::Vector2d& p : thinned(points_in_base(scan, Eigen::Isometry3d::Identity()), 0.1))
        EXPECT_TRUE(p.allFinite());
    }
  }
  EXPECT_TRUE(points_in_base(scan_with({1, 2, 3}), Eigen::Isometry3d::Identity(), {kNaN, 0, 0}).size() <= 1);
}

TEST(BeamReturns, UndoTheRobotsMotionDuringTheSweep) {
  // The robot turns and drives while the beams go round; de-skewed, all returns lie on the walls again.
  const test::Segments walls = test::room();
  const Pose2 start{0.3, -0.4, 0.2}, motion{0.15, 0.02, 0.3};
  const Eigen::Isometry3d base_T_laser = mounting(0.25, 0, 0.4, 0.1, 0, 0);
  LaserScan scan = scan_with(std::vector<float>(541));
  scan.angle_min_rad = radians(-135), scan.angle_increment_rad = radians(0.5);
  scan.time_increment_s = 0.0001;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const Pose2 laser =
        start * interpolate({}, motion, static_cast<double>(i) / 540.0) * to_pose2(base_T_laser);
    const double angle = laser.yaw + scan.angle_min_rad + static_cast<double>(i) * scan.angle_increment_rad;
    scan.ranges_m[i] =
        static_cast<float>(*test::cast(walls, laser.position(), {std::cos(angle), std::sin(angle)}));
  }
  const auto distance_to_walls = [&](const Eigen::Vector2d& p) {
    double nearest = kInfinity;
    for (const test::Segment& s : walls) {
      const double share = std::clamp((p - s.a).dot(s.b - s.a) / (s.b - s.a).squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (p - s.a - share * (s.b - s.a)).norm());
    }
    return nearest;
  };
  double worst_skewed = 0, worst = 0;
  for (const Eigen::Vector2d& p : points_in_base(scan, base_T_laser))
    worst_skewed = std::max(worst_skewed, distance_to_walls(start * p));
  for (const Eigen::Vector2d& p : points_in_base(scan, base_T_laser, motion))
    worst = std::max(worst, distance_to_walls(start * p));
  EXPECT_GT(worst_skewed, 0.2);
  EXPECT_LT(worst, 1e-5);
  EXPECT_NEAR(sweep_duration_s(scan), 0.054, 1e-9);
  const std::vector<BeamReturn> returns = beam_returns(scan, base_T_laser, motion);
  EXPECT_NEAR((returns.front().origin_m - Eigen::Vector2d(0.25, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((returns.back().origin_m - motion * Eigen::Vector2d(0.25, 0)).norm(), 0, 1e-9);
}

PointSet random_points(Random& random, int count) {
  PointSet points;
  for (int i = 0; i < count; ++i) points.emplace_back(random.uniform(-3, 3), random.uniform(-3, 3));
  return points;
}

TEST(Thinned, KeepsPointsApartAndLeavesNoneFarFromAKeptOne) {
  Random random(1);
  for (const double spacing_m : {0.05, 0.3, 1.0}) {
    const PointSet points = random_points(random, 600), kept = thinned(points, spacing_m);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) EXPECT_GE((kept[i] - kept[j]).norm(), spacing_m);
    }
    for (const Eigen::Vector2d& p : points) {
      EXPECT_TRUE(std::any_of(kept.begin(), kept.end(),
                              [&](const Eigen::Vector2d& k) { return (k - p).norm() < spacing_m; }));
    }
  }
}

TEST(Thinned, ChoosesTheSamePointsHoweverTheyAreMoved) {
  Random random(2);
  const PointSet points = random_points(random, 500);
  const Pose2 motion{13.0, -7.5, 1.1};
  const PointSet first = transformed(motion, thinned(points, 0.2)),
                 second = thinned(transformed(motion, points), 0.2);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_NEAR((first[i] - second[i]).norm(), 0, 1e-9);
}

TEST(Thinned, EvensOutNearAndFarWalls) {
  // 1 m of wall at 1 m and at 10 m: a hundred beams against ten, about the same number of points.
  PointSet points;
  for (int i = 0; i < 100; ++i) points.emplace_back(1.0, 0.01 * i);
  for (int i = 0; i < 10; ++i) points.emplace_back(10.0, 0.1 * i);
  const PointSet kept = thinned(points, 0.0999);
  EXPECT_EQ(std::count_if(kept.begin(), kept.end(), [](const Eigen::Vector2d& p) { return p.x() < 5; }), 10);
  EXPECT_EQ(kept.size(), 20U);
  EXPECT_EQ(thinned(points, 0).size(), points.size());
}

TEST(AtMost, SpreadsItsChoiceEvenly) {
  PointSet points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(i, 0);
  const PointSet kept = at_most(points, 300);
  ASSERT_EQ(kept.size(), 300U);
  for (std::size_t i = 1; i < kept.size(); ++i) {
    EXPECT_GE(kept[i].x() - kept[i - 1].x(), 3);
    EXPECT_LE(kept[i].x() - kept[i - 1].x(), 4);
  }
  EXPECT_EQ(at_most(points, 2000).size(), 1000U);
  EXPECT_TRUE(at_most(points, 0).empty());
}

}  // namespace
}  // namespace mstsl
