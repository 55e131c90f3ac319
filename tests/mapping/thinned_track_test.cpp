#include "mstsl/mapping/thinned_track.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

/// A drive of curves, stops and slow turns at 100 Hz, as odometry has it: to a tenth of a millimetre.
std::vector<TimedPose> drive(int readings) {
  std::vector<TimedPose> poses;
  Random random(3);
  Pose2 pose;
  for (int i = 0; i < readings; ++i) {
    const double t = 0.01 * i, v = std::max(0.0, std::sin(0.1 * t)), w = 0.5 * std::sin(0.37 * t);
    pose = pose * Pose2::from({0.01 * v + random.normal(0, 5e-5), 0}, 0.01 * w);
    poses.push_back({Stamp{} + t, pose});
  }
  return poses;
}

TEST(ThinnedTrack, KeepsTheWayToAMillimetre) {
  const std::vector<TimedPose> whole = drive(20000);
  ThinnedTrack thinned;
  for (const TimedPose& at : whole) thinned.add(at);
  Trajectory kept;
  for (const TimedPose& at : thinned.poses()) ASSERT_TRUE(kept.add(at.stamp, at.pose));
  EXPECT_LT(kept.size(), whole.size() / 5);
  EXPECT_EQ(kept.front().stamp, whole.front().stamp);
  EXPECT_EQ(kept.back().stamp, whole.back().stamp);
  for (const TimedPose& at : whole) {
    const auto between = kept.at(at.stamp, 0.26);
    ASSERT_TRUE(between);
    EXPECT_LT(distance(*between, at.pose), 1e-3 + 1e-9);
    EXPECT_LT(std::abs(angle_between(between->yaw, at.pose.yaw)), radians(0.03) + 1e-9);
  }
}

TEST(ThinnedTrack, KeepsJumpsAndLongSilences) {
  constexpr std::int64_t kMs = 1'000'000;
  ThinnedTrack thinned;
  for (const std::int64_t ms : {0, 100, 200, 5000, 5100})
    thinned.add({Stamp{ms * kMs}, {ms < 5050 ? 0.0 : 1.0, 0, 0}});
  thinned.add({Stamp{5100 * kMs}, {9, 9, 9}});  // no later than the last
  thinned.add({Stamp{5200 * kMs}, {1.0, 0, 0}});
  std::vector<std::int64_t> kept_ms;
  for (const TimedPose& at : thinned.poses()) kept_ms.push_back(at.stamp.ns / kMs);
  EXPECT_EQ(kept_ms, (std::vector<std::int64_t>{0, 200, 5000, 5100, 5200}));
}

}  // namespace
}  // namespace mstsl
