#include "mstsl/eval/run_loop.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace mstsl {
namespace {

/// Processes every second scan and knows its pose from the fourth on.
struct EverySecondScan {
  int scans = 0;
  Estimate now;

  void observe(const OdometryReading&) { now.travelled_m += 1.0; }
  void observe(const OdometryRestart&) {}
  void observe(const FieldReading&) {}
  void observe(const LaserScan& scan) {
    if (++scans % 2 == 1) return;
    now.stamp = scan.stamp;
    if (scans >= 4) now.status = LocalizationStatus::kLocalized, now.map_T_base = Pose2{};
  }
  Estimate estimate() const { return now; }
  LocalizerReport report() const { return {}; }
};
static_assert(Localizer<EverySecondScan>);

LaserScan scan_at(double seconds) {
  LaserScan scan;
  scan.stamp = Stamp::from_seconds(seconds);
  return scan;
}

TEST(RunLoop, HandsOnOneEstimateForEachScanThatWasProcessed) {
  std::vector<Estimate> estimates;
  RunLoop loop(AnyLocalizer(EverySecondScan{}), [&](const Estimate& e) { estimates.push_back(e); });
  for (int i = 1; i <= 6; ++i) {
    const OdometryReading odometry{Stamp::from_seconds(i - 0.5), {}};
    const FieldReading field{Stamp::from_seconds(i + 0.1), Eigen::Vector3d::Zero()};
    loop.observe(odometry);
    loop.observe(scan_at(i));
    loop.observe(field);
    loop.observe(PoseReading{Stamp::from_seconds(i + 0.2), {}});
  }
  ASSERT_EQ(estimates.size(), 3u);
  EXPECT_EQ(estimates[0].stamp, Stamp::from_seconds(2));
  EXPECT_FALSE(estimates[0].map_T_base);
  EXPECT_TRUE(estimates[1].map_T_base);
  EXPECT_EQ(loop.counts().scans, 6u);
  EXPECT_EQ(loop.counts().odometry, 6u);
  EXPECT_EQ(loop.counts().field_readings, 6u);
  EXPECT_EQ(loop.counts().estimates, 3u);
  EXPECT_DOUBLE_EQ(*loop.counts().time_to_fix_s, 3.5);
  EXPECT_DOUBLE_EQ(*loop.counts().distance_to_fix_m, 4.0);
}

TEST(RunLoop, ADuplicateScanGivesNoSecondEstimate) {
  std::vector<Estimate> estimates;
  RunLoop loop(AnyLocalizer(EverySecondScan{}), [&](const Estimate& e) { estimates.push_back(e); });
  for (const double t : {1.0, 2.0, 2.0, 2.0}) loop.observe(scan_at(t));
  EXPECT_EQ(estimates.size(), 1u);
}

}  // namespace
}  // namespace mstsl
