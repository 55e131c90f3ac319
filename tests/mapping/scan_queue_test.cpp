#include "mstsl/mapping/scan_queue.hpp"

#include <gtest/gtest.h>

namespace mstsl {
namespace {

LaserScan scan_at(double seconds) {
  LaserScan scan;
  scan.stamp = Stamp::from_seconds(seconds);
  scan.time_increment_s = 0.001;
  scan.ranges_m.assign(101, 1.0F);  // a sweep of 0.1 s
  return scan;
}

OdometryReading at(double seconds) { return {Stamp::from_seconds(seconds), {0.5 * seconds, 0, 0}}; }

TEST(ScanQueue, AScanWaitsForTheOdometryToItsEnd) {
  ScanQueue queue;
  queue.observe(at(0.0));
  queue.observe(scan_at(0.05));
  queue.observe(at(0.1));
  EXPECT_FALSE(queue.next(false));
  queue.observe(at(0.2));
  const auto placed = queue.next(false);
  ASSERT_TRUE(placed);
  EXPECT_NEAR(placed->track_T_base.x, 0.025, 1e-9);
  EXPECT_NEAR(placed->track_T_end.x, 0.075, 1e-9);
  EXPECT_FALSE(queue.next(true));
}

TEST(ScanQueue, AtTheEndTheLastScanIsPlacedAsWellAsItCanBe) {
  ScanQueue queue;
  queue.observe(at(0.0));
  queue.observe(at(0.1));
  queue.observe(scan_at(0.08));
  EXPECT_FALSE(queue.next(false));
  EXPECT_TRUE(queue.next(true));
}

TEST(ScanQueue, AScanStampedFarAheadKeepsNoOtherOut) {
  ScanQueue queue;
  int placed = 0;
  for (int i = 0; i <= 100; ++i) {
    queue.observe(at(0.1 * i));
    queue.observe(scan_at(i == 10 ? 5000.0 : 0.1 * i));
    while (queue.next(false)) ++placed;
  }
  while (queue.next(true)) ++placed;
  EXPECT_GE(placed, 85);
  EXPECT_EQ(queue.scans_seen(), 101U);
}

TEST(ScanQueue, ScansOfTimesWithoutOdometryAreLeftOut) {
  ScanQueue queue;
  queue.observe(scan_at(1.0));
  queue.observe(at(100.0));
  queue.observe(at(100.1));
  queue.observe(scan_at(100.0));
  queue.observe(at(100.2));
  const auto placed = queue.next(false);
  ASSERT_TRUE(placed);
  EXPECT_EQ(placed->scan.stamp, Stamp::from_seconds(100.0));
}

}  // namespace
}  // namespace mstsl
