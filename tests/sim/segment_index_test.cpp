#include "mstsl/sim/segment_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;

std::vector<Segment> random_segments(Random& random, int count) {
  std::vector<Segment> segments;
  for (int i = 0; i < count; ++i) {
    const Vector2d a(random.uniform(-20, 20), random.uniform(-10, 10));
    const double length = random.chance(0.1) ? 30.0 : random.uniform(0.0, 3.0),
                 angle = random.uniform(-kPi, kPi);
    segments.push_back({a, a + length * Vector2d(std::cos(angle), std::sin(angle))});
  }
  return segments;
}

/// The plain way: every segment in turn.
std::optional<double> cast_plainly(const std::vector<Segment>& segments, const Vector2d& origin,
                                   const Vector2d& direction, double max_m) {
  std::optional<double> nearest;
  for (const Segment& s : segments)
    if (const auto hit = SegmentIndex({s}).cast(origin, direction, max_m);
        hit && (!nearest || hit->range_m < *nearest))
      nearest = hit->range_m;
  return nearest;
}

TEST(SegmentIndex, CastsRaysAsTheSearchOfAllSegmentsDoes) {
  Random random(1);
  for (const double bucket_m : {0.3, 1.0, 7.0}) {
    const std::vector<Segment> segments = random_segments(random, 150);
    const SegmentIndex index(segments, bucket_m);
    int hits = 0;
    for (int i = 0; i < 400; ++i) {
      const Vector2d origin(random.uniform(-30, 30), random.uniform(-20, 20));
      const double angle = i % 10 == 0 ? radians(90) * (i / 10 % 4) : random.uniform(-kPi, kPi);
      const Vector2d direction(std::cos(angle), std::sin(angle));
      const auto hit = index.cast(origin, direction, 25.0);
      const auto plain = cast_plainly(segments, origin, direction, 25.0);
      ASSERT_EQ(hit.has_value(), plain.has_value()) << "ray " << i;
      if (!hit) continue;
      ++hits;
      EXPECT_DOUBLE_EQ(hit->range_m, *plain);
      EXPECT_NEAR(distance(origin + hit->range_m * direction, segments[hit->segment]), 0.0, 1e-9);
    }
    EXPECT_GT(hits, 200);
  }
}

TEST(SegmentIndex, MeetsWallsThatRunAlongTheBucketsEdges) {
  const SegmentIndex index({{{0, 0}, {10, 0}}, {{10, 0}, {10, 5}}}, 1.0);
  const auto down = index.cast({3.0, 2.0}, {0, -1}, 30);
  ASSERT_TRUE(down);
  EXPECT_DOUBLE_EQ(down->range_m, 2.0);
  EXPECT_DOUBLE_EQ(down->cos_incidence, 1.0);
  const auto right = index.cast({3.0, 2.0}, {1, 0}, 30);
  ASSERT_TRUE(right);
  EXPECT_DOUBLE_EQ(right->range_m, 7.0);
  EXPECT_FALSE(index.cast({3.0, 2.0}, {0, 1}, 30));
  EXPECT_FALSE(index.cast({3.0, 2.0}, {1, 0}, 6.9));
}

TEST(SegmentIndex, GivesTheCosineOfIncidence) {
  const SegmentIndex index({{{-50, 1}, {50, 1}}});
  const double angle = radians(10.0);
  const auto hit = index.cast({0, 0}, {std::cos(angle), std::sin(angle)}, 30);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->range_m, 1.0 / std::sin(angle), 1e-12);
  EXPECT_NEAR(hit->cos_incidence, std::sin(angle), 1e-12);
}

TEST(SegmentIndex, FindsTheNearestSegment) {
  Random random(2);
  const std::vector<Segment> segments = random_segments(random, 60);
  const SegmentIndex index(segments, 0.7);
  for (int i = 0; i < 300; ++i) {
    const Vector2d point(random.uniform(-30, 30), random.uniform(-20, 20));
    double nearest = 4.0;
    for (const Segment& s : segments) nearest = std::min(nearest, distance(point, s));
    EXPECT_DOUBLE_EQ(index.clearance(point, 4.0), nearest);
  }
}

TEST(SegmentIndex, IsAnOpenPlainWithoutSegments) {
  const SegmentIndex none;
  EXPECT_FALSE(none.cast({0, 0}, {1, 0}, 30));
  EXPECT_EQ(none.clearance({0, 0}, 2.0), 2.0);
  EXPECT_FALSE(none.blocked({0, 0}, {5, 5}));
}

TEST(SegmentIndex, TellsWhetherAWallStandsBetween) {
  const SegmentIndex index(box({1, 2, 0.3}, {2, 1}));
  EXPECT_TRUE(index.blocked({1, 2}, {9, 9}));
  EXPECT_FALSE(index.blocked({5, 5}, {9, 9}));
  EXPECT_FALSE(index.blocked({1, 2}, {1, 2}));
}

TEST(Segment, KnowsCrossingsAndDistances) {
  EXPECT_TRUE(intersect({{0, 0}, {2, 2}}, {{0, 2}, {2, 0}}));
  EXPECT_FALSE(intersect({{0, 0}, {1, 1}}, {{2, 2}, {3, 3}}));
  EXPECT_FALSE(intersect({{0, 0}, {1, 0}}, {{0, 1}, {1, 1}}));
  EXPECT_DOUBLE_EQ(distance({3, 4}, {{0, 0}, {0, 0}}), 5.0);
  EXPECT_DOUBLE_EQ(distance({1, 1}, {{0, 0}, {2, 0}}), 1.0);
}

}  // namespace
}  // namespace mstsl::sim
