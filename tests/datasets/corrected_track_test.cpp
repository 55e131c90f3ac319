#include "mstsl/datasets/corrected_track.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

namespace mstsl::datasets {
namespace {

Stamp at_s(double seconds) { return Stamp::from_seconds(seconds); }

/// A robot on a circle of 5 m, 0.1 rad/s; what it truly does.
Pose2 circling(double seconds) {
  const double angle_rad = 0.1 * seconds;
  return Pose2::from({5.0 * std::sin(angle_rad), 5.0 - 5.0 * std::cos(angle_rad)}, angle_rad);
}

std::vector<PoseReading> corrected_every(double step_s, int count) {
  std::vector<PoseReading> poses;
  for (int i = 0; i < count; ++i) poses.push_back({at_s(i * step_s), circling(i * step_s)});
  return poses;
}

std::vector<OdometryReading> odometry_of(const Pose2& odom_T_map, double scale, double step_s, int count) {
  std::vector<OdometryReading> readings;
  for (int i = 0; i < count; ++i) {
    Pose2 pose = circling(i * step_s);
    pose.x *= scale;
    pose.y *= scale;
    readings.push_back({at_s(i * step_s), odom_T_map * pose});
  }
  return readings;
}

void expect_near(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_LT(distance(a, b), tolerance);
  EXPECT_LT(std::abs(angle_between(a.yaw, b.yaw)), tolerance);
}

TEST(CorrectedTrack, PassesThroughEveryCorrectedPose) {
  const auto corrected = corrected_every(3.0, 8);
  const CorrectedTrack track(corrected, odometry_of({7.0, -2.0, 1.0}, 1.2, 0.1, 220));
  for (const PoseReading& pose : corrected) expect_near(track.at(pose.stamp), pose.map_T_base, 1e-12);
}

TEST(CorrectedTrack, FollowsGoodOdometryBetweenThem) {
  const auto corrected = corrected_every(6.0, 4);
  const CorrectedTrack track(corrected, odometry_of({7.0, -2.0, 1.0}, 1.0, 0.05, 400));
  for (double seconds = 0.0; seconds <= 18.0; seconds += 0.05)
    expect_near(track.at(at_s(seconds)), circling(seconds), 1e-9);
}

TEST(CorrectedTrack, IsContinuousUnderBadOdometry) {
  const auto corrected = corrected_every(3.0, 6);
  const CorrectedTrack track(corrected, odometry_of({0.0, 0.0, 0.0}, 1.5, 0.1, 160));
  for (double seconds = 0.0; seconds < 15.0; seconds += 0.01)
    EXPECT_LT(distance(track.at(at_s(seconds)), track.at(at_s(seconds + 0.01))), 0.5 * 1.5 * 0.01 + 0.01);
}

TEST(CorrectedTrack, GoesStraightWhereThereIsNoOdometry) {
  const std::vector<PoseReading> corrected = {{at_s(0.0), {0.0, 0.0, 0.0}}, {at_s(2.0), {4.0, 2.0, 1.0}}};
  expect_near(CorrectedTrack(corrected, {}).at(at_s(0.5)), {1.0, 0.5, 0.25}, 1e-12);
}

TEST(CorrectedTrack, StandsBeforeItsBeginningAndAfterItsEnd) {
  const std::vector<PoseReading> corrected = {{at_s(1.0), {3.0, 4.0, 0.5}}};
  const CorrectedTrack track(corrected, odometry_of({}, 1.0, 0.1, 20));
  expect_near(track.at(at_s(0.0)), corrected.front().map_T_base, 1e-15);
  expect_near(track.at(at_s(9.0)), corrected.front().map_T_base, 1e-15);
}

}  // namespace
}  // namespace mstsl::datasets
