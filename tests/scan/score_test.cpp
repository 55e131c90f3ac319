#include "mstsl/scan/score.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "segment_world.hpp"

namespace mstsl {
namespace {

double brute_force(const OccupancyGrid& map, const PointSet& points, const Pose2& pose, double tolerance_m) {
  double hits = 0;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d at_m = map.geometry().to_grid(pose * p) * map.geometry().resolution_m;
    bool hit = false;
    for (std::size_t i = 0; i < map.geometry().size() && !hit; ++i) {
      if (map.values()[i] != CellState::kOccupied) continue;
      const Eigen::Vector2d low = Eigen::Vector2d(map.geometry().cell(i).column, map.geometry().cell(i).row) *
                                  map.geometry().resolution_m;
      const Eigen::Vector2d nearest =
          at_m.cwiseMax(low).cwiseMin((low.array() + map.geometry().resolution_m).matrix());
      hit = (at_m - nearest).norm() <= tolerance_m;
    }
    hits += hit;
  }
  return hits / static_cast<double>(points.size());
}

PointSet scan_points(const Pose2& pose, Random& random, double noise_m) {
  return points_in_base(test::scan_of(test::room(), pose, random, {.beams = 271, .noise_m = noise_m}),
                        Eigen::Isometry3d::Identity());
}

TEST(ConfidenceScore, AgreesWithBruteForce) {
  Random random(1);
  const OccupancyGrid map = test::drawn(test::room(), test::square_around({0.1, 0.2, 0.5}, 4.5));
  for (int trial = 0; trial < 10; ++trial) {
    const Pose2 truth{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)};
    const PointSet points = scan_points(truth, random, 0.03);
    const Pose2 pose = truth * Pose2{random.normal(0, 0.1), random.normal(0, 0.1), random.normal(0, 0.05)};
    const double tolerance_m = random.uniform(0, 0.15);
    EXPECT_NEAR(confidence_score(map, points, pose, {.hit_tolerance_m = tolerance_m}),
                brute_force(map, points, pose, tolerance_m), 1e-9);
  }
}

TEST(ConfidenceScore, OfAPerfectScanIsOne) {
  Random random(2);
  const OccupancyGrid map = test::drawn(test::room(), test::square_around({0.1, 0.2, 0.5}, 6));
  const Pose2 truth{0.4, -0.7, 1.0};
  EXPECT_EQ(confidence_score(map, scan_points(truth, random, 0.0), truth, {.hit_tolerance_m = 1e-5}), 1.0);
  EXPECT_GT(confidence_score(map, scan_points(truth, random, 0.01), truth), 0.99);
}

TEST(ConfidenceScore, FallsBelowTheThresholdAtAWrongPlace) {
  Random random(3);
  const OccupancyGrid map = test::drawn(test::room(), test::square_around({}, 6));
  const Pose2 truth{0.4, -0.7, 1.0};
  const PointSet points = scan_points(truth, random, 0.01);
  for (int trial = 0; trial < 200; ++trial) {
    const Pose2 wrong{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
    const double score = confidence_score(map, points, wrong);
    EXPECT_GE(score, 0.0);
    EXPECT_LE(score, 1.0);
    if (distance(wrong, truth) > 0.5) {
      EXPECT_LT(score, kConfidenceThreshold);
    }
  }
}

TEST(ConfidenceScore, MovesWithTheWorld) {
  Random random(4);
  GridGeometry geometry = test::square_around({}, 6);
  const OccupancyGrid map = test::drawn(test::room(), geometry);
  const Pose2 motion{12, -5, 2.2}, pose{0.4, -0.7, 1.0};
  geometry.map_T_grid = motion * geometry.map_T_grid;
  const PointSet points = scan_points(pose, random, 0.05);
  EXPECT_NEAR(confidence_score(map, points, pose),
              confidence_score(OccupancyGrid(geometry, map.values()), points, motion * pose), 0.01);
}

TEST(ConfidenceScore, LeavesOutPointsBeyondTheRange) {
  OccupancyGrid map({.resolution_m = 0.05, .columns = 100, .rows = 100}, CellState::kFree);
  map[{40, 20}] = CellState::kOccupied;
  const PointSet points{{1.0, 0.0}, {2.5, 0.0}};
  const Pose2 pose{1.025, 1.025, 0};
  EXPECT_EQ(confidence_score(map, points, pose), 0.5);
  EXPECT_EQ(confidence_score(map, points, pose, {.max_range_m = 2.0}), 1.0);
  EXPECT_EQ(confidence_score(map, points, pose, {.max_range_m = 0.5}), 0.0);
  EXPECT_EQ(confidence_score(map, {}, pose), 0.0);
  EXPECT_EQ(confidence_score(map, PointSet(3, {1e300, 1e300}), pose), 0.0);
  EXPECT_EQ(confidence_score(OccupancyGrid(), points, pose), 0.0);
}

/// A wall at x = 2 m with a door in it, and nothing known behind.
OccupancyGrid wall_with_a_door() {
  OccupancyGrid map({.resolution_m = 0.05, .columns = 100, .rows = 100}, CellState::kUnknown);
  for (int row = 0; row < 100; ++row) {
    for (int column = 0; column < 40; ++column) map[{column, row}] = CellState::kFree;
    if (row < 40 || row >= 60) map[{40, row}] = CellState::kOccupied;
  }
  return map;
}

TEST(ConfidenceScore, DoesNotAskPointsSeenThroughADoorIntoTheUnmapped) {
  const OccupancyGrid map = wall_with_a_door();
  const Pose2 pose{1.0, 2.5, 0};
  const PointSet points{{1.02, 1.2}, {1.02, -1.2}, {3.0, 0.0}};  // wall, wall, through the door
  EXPECT_NEAR(confidence_score(map, points, pose), 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(confidence_score(map, points, pose, {.unmapped_is_miss = false}), 1.0, 1e-12);
}

TEST(ConfidenceScore, AsksPointsBehindAWallAndInFreeSpace) {
  const OccupancyGrid map = wall_with_a_door();
  const Pose2 pose{1.0, 2.5, 0};
  const PointSet points{
      {1.02, 1.2}, {1.02, -1.2}, {3.0, 2.0}, {0.3, 0.0}};  // ..., behind the wall, in the open
  EXPECT_NEAR(confidence_score(map, points, pose, {.unmapped_is_miss = false}), 0.5, 1e-12);
}

TEST(ConfidenceScore, IsNotHighWhereMostOfTheScanLeavesTheMap) {
  const OccupancyGrid map = wall_with_a_door();
  const PointSet points{{1.02, 1.2}, {3.0, 0.0}, {3.0, 0.1}, {3.0, -0.1}};
  EXPECT_NEAR(confidence_score(map, points, {1.0, 2.5, 0}, {.unmapped_is_miss = false}), 0.5, 1e-12);
  EXPECT_EQ(confidence_score(map, {{50.0, 0.0}}, {1.0, 2.5, 0}, {.unmapped_is_miss = false}), 0.0);
}

}  // namespace
}  // namespace mstsl
