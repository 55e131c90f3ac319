#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"
#include "mstsl/magnetic/lanes.hpp"
#include "mstsl/magnetic/outliers.hpp"

#include "point_bins.hpp"

namespace mstsl {
namespace {

Fingerprint at(double x, double y, int session = 0) {
  return {{x, y}, {20.0, 3 * std::sin(x), -40.0}, 0.0, session};
}

TEST(PointBins, FindsWhatALookAtEveryPointFinds) {
  Random random(1);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 500; ++i) points.push_back({random.uniform(-5, 5), random.uniform(-5, 5)});
  points.push_back({1e300, -1e300});  // hostile, but no reason to fail
  const PointBins bins(points, 0.7);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector2d low(random.uniform(-6, 5), random.uniform(-6, 5));
    const Eigen::Vector2d high = low + Eigen::Vector2d(random.uniform(0, 4), random.uniform(0, 4));
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < points.size(); ++i)
      if ((points[i].array() >= low.array()).all() && (points[i].array() <= high.array()).all())
        expected.push_back(i);
    EXPECT_EQ(bins.in_box(low, high), expected);
  }
}

TEST(Lanes, ADriveToAndFroIsOneLaneEachWay) {
  std::vector<Fingerprint> drive;
  for (double x = 0; x < 5; x += 0.05) drive.push_back(at(x, 0));
  for (double x = 5; x > 0; x -= 0.05) drive.push_back(at(x, 0.1));
  const auto lanes = split_lanes(drive);
  ASSERT_EQ(lanes.size(), 2u);
  EXPECT_NEAR(static_cast<double>(lanes[0].size()), 100, 8);
}

TEST(Lanes, CornersGapsSessionsAndLengthEndALane) {
  std::vector<Fingerprint> drive;
  for (double x = 0; x < 3; x += 0.05) drive.push_back(at(x, 0));
  for (double y = 0; y < 3; y += 0.05) drive.push_back(at(3, y));       // corner
  for (double y = 4; y < 7; y += 0.05) drive.push_back(at(3, y));       // gap
  for (double y = 7; y < 10; y += 0.05) drive.push_back(at(3, y, 1));   // session
  for (double y = 10; y < 35; y += 0.05) drive.push_back(at(3, y, 1));  // length
  const auto lanes = split_lanes(drive);
  EXPECT_EQ(lanes.size(), 6u);
  std::size_t next = 0;
  for (const Lane& lane : lanes) {
    EXPECT_EQ(lane.first, next);
    next = lane.last;
  }
  EXPECT_EQ(next, drive.size());
}

TEST(Lanes, NothingHasNoLanes) { EXPECT_TRUE(split_lanes({}).empty()); }

TEST(Outliers, OneReadingOfAThousandMicroteslaIsFoundAlone) {
  std::vector<Fingerprint> drive;
  for (double x = 0; x < 10; x += 0.05) drive.push_back(at(x, 0));
  drive[77].field_uT.y() += 1000;
  EXPECT_EQ(find_outliers(drive), std::vector<std::size_t>{77});
}

TEST(Outliers, ASteepButRealFieldIsKept) {
  std::vector<Fingerprint> drive;
  for (int way = 0; way < 2; ++way)
    for (double x = -3; x < 3; x += 0.05) {  // a column at 0.3 m: 60 uT over a few decimetres
      Fingerprint f = at(x, 0.05 * way);
      f.field_uT.x() += 60 / std::pow(1 + x * x / 0.09, 1.5);
      drive.push_back(f);
    }
  EXPECT_TRUE(find_outliers(drive).empty());
}

TEST(Outliers, FingerprintsWithoutNeighboursAreNotJudged) {
  EXPECT_TRUE(find_outliers(std::vector<Fingerprint>{at(0, 0), at(10, 0), at(20, 0)}).empty());
}

}  // namespace
}  // namespace mstsl
