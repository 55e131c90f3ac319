#include "mstsl/datasets/lattice_lanes.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

namespace mstsl::datasets {
namespace {

Fingerprint at(double x_m, double y_m) {
  Fingerprint point;
  point.position_m = {x_m, y_m};
  return point;
}

/// A corridor of three rows along x, and one of three columns along y that leaves it.
std::vector<Fingerprint> shuffled_corridors() {
  std::vector<Fingerprint> points;
  for (int row = 0; row < 3; ++row)
    for (int i = 0; i < 40; ++i) points.push_back(at(0.5 * i, 0.6 * row));
  for (int column = 0; column < 3; ++column)
    for (int i = 1; i <= 20; ++i) points.push_back(at(0.5 * (10 + column), 1.2 + 0.5 * i));
  Random random(1);
  for (std::size_t i = points.size() - 1; i > 0; --i) std::swap(points[i], points[random.index(i + 1)]);
  return points;
}

TEST(LatticeLanes, RunAlongTheCorridorsNotAcrossThem) {
  const auto lanes = lattice_lanes(shuffled_corridors());
  ASSERT_EQ(lanes.size(), 6U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(lanes[i].size(), 40U);
  for (std::size_t i = 3; i < 6; ++i) EXPECT_EQ(lanes[i].size(), 23U);  // they begin in the first corridor
}

TEST(LatticeLanes, AreInOrderWithoutGaps) {
  for (const auto& lane : lattice_lanes(shuffled_corridors()))
    for (std::size_t i = 1; i < lane.size(); ++i) {
      const Eigen::Vector2d step = lane[i].position_m - lane[i - 1].position_m;
      EXPECT_GT(step.sum(), 0.0);
      EXPECT_LE(step.norm(), 0.85);
      EXPECT_NEAR(step.x() * step.y(), 0.0, 1e-9);
    }
}

TEST(LatticeLanes, EndWhereSomethingStandsBetween) {
  std::vector<Fingerprint> points;
  for (int i = 0; i < 40; ++i)
    if (i != 20) points.push_back(at(0.5 * i, 0.0));
  const auto lanes = lattice_lanes(points);
  ASSERT_EQ(lanes.size(), 2U);
  EXPECT_EQ(lanes[0].size(), 20U);
  EXPECT_EQ(lanes[1].size(), 19U);
}

TEST(LatticeLanes, AreNoneWithoutEnoughPoints) {
  EXPECT_TRUE(lattice_lanes({}).empty());
  EXPECT_TRUE(lattice_lanes(std::vector<Fingerprint>{at(0, 0), at(0.5, 0), at(1, 0)}).empty());
}

}  // namespace
}  // namespace mstsl::datasets
