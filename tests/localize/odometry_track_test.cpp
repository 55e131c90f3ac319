#include "mstsl/localize/odometry_track.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

Stamp at_s(double seconds) { return Stamp::from_seconds(seconds); }

/// 1 m/s along x from `from_x`, 10 Hz, `count` readings from `start_s` on.
void drive(OdometryTrack& track, double start_s, int count, double from_x) {
  for (int i = 0; i < count; ++i) track.add({at_s(start_s + 0.1 * i), {from_x + 0.1 * i, 0.0, 0.0}});
}

TEST(OdometryTrack, FollowsTheReadingsAndSumsTheWay) {
  OdometryTrack track;
  drive(track, 0.0, 11, 5.0);
  EXPECT_NEAR(track.travelled_m(), 1.0, 1e-9);
  EXPECT_NEAR(track.at(at_s(0.55))->x, 5.55, 1e-9);
  EXPECT_EQ(track.breaks(), 0u);
}

TEST(OdometryTrack, ExtrapolatesAMomentAndNoMore) {
  OdometryTrack track;
  drive(track, 0.0, 11, 0.0);
  EXPECT_NEAR(track.at(at_s(1.05))->x, 1.05, 1e-9);
  EXPECT_FALSE(track.at(at_s(2.0)));
  EXPECT_FALSE(OdometryTrack().at(at_s(0.0)));
}

TEST(OdometryTrack, AJumpBreaksTheChainAndMovesNothing) {
  OdometryTrack track;
  drive(track, 0.0, 11, 0.0);
  drive(track, 1.1, 11, 100.0);
  EXPECT_EQ(track.breaks(), 1u);
  EXPECT_NEAR(track.at(at_s(2.1))->x, 2.0, 1e-9);
  EXPECT_NEAR(track.travelled_m(), 2.0, 1e-9);
}

TEST(OdometryTrack, ARestartBreaksTheChainEvenWhenThePoseLooksPlausible) {
  OdometryTrack track;
  drive(track, 0.0, 11, 0.0);
  track.restart({at_s(1.05)});
  drive(track, 1.1, 2, 1.1);
  EXPECT_EQ(track.breaks(), 1u);
  EXPECT_NEAR(track.at(at_s(1.1))->x, 1.0, 1e-9);
}

TEST(OdometryTrack, GoesOnInItsOwnFrameAfterARestartWithAnotherHeading) {
  OdometryTrack track;
  drive(track, 0.0, 11, 0.0);
  track.restart({at_s(1.05)});
  for (int i = 0; i < 11; ++i) track.add({at_s(1.1 + 0.1 * i), {0.0, 0.1 * i, radians(90)}});
  EXPECT_NEAR(track.at(at_s(2.1))->x, 2.0, 1e-9);
  EXPECT_NEAR(track.at(at_s(2.1))->y, 0.0, 1e-9);
}

TEST(OdometryTrack, DropsWhatIsNotFiniteOrLate) {
  OdometryTrack track;
  drive(track, 0.0, 11, 0.0);
  track.add({at_s(0.3), {9.0, 0.0, 0.0}});
  track.add({at_s(1.0), {9.0, 0.0, 0.0}});
  track.add({at_s(1.1), {std::numeric_limits<double>::infinity(), 0.0, 0.0}});
  track.add({at_s(1.2), {0.0, 0.0, std::numeric_limits<double>::quiet_NaN()}});
  EXPECT_EQ(track.dropped(), 4u);
  EXPECT_NEAR(track.at(at_s(1.0))->x, 1.0, 1e-9);
}

/// As in the Intel log of 2003: silence, then five readings with stamps a microsecond apart.
void burst(OdometryTrack& track, double at, double from_x) {
  for (int i = 0; i < 5; ++i) track.add({at_s(at + 1e-6 * i), {from_x + 0.06 * i, 0.0, 0.0}});
}

TEST(OdometryTrack, ReadingsHeldUpAndSentTogetherAreOneMotion) {
  OdometryTrack track;
  for (int i = 0; i < 10; ++i) burst(track, 0.6 * i, 0.3 * i);
  EXPECT_EQ(track.breaks(), 0u);
  EXPECT_NEAR(track.travelled_m(), 0.3 * 9 + 0.24, 1e-9);
}

TEST(OdometryTrack, ABurstTellsNoSpeedToGoOnWith) {
  OdometryTrack track;
  for (int i = 0; i < 10; ++i) burst(track, 0.25 * i, 0.3 * i);
  const double last_m = 0.3 * 9 + 0.24, speed_m_s = 1.2;
  EXPECT_NEAR(track.at(at_s(0.25 * 9 + 0.1))->x, last_m + 0.1 * speed_m_s, 0.13);
}

TEST(OdometryTrack, AJumpWithinABurstStillBreaksTheChain) {
  OdometryTrack track;
  burst(track, 0.0, 0.0);
  burst(track, 0.2, 0.3);
  track.add({at_s(0.2 + 1e-5), {100.0, 0.0, 0.0}});
  EXPECT_EQ(track.breaks(), 1u);
}

TEST(OdometryTrack, AFastDriverIsNoBurst) {
  OdometryTrack track;  // 1 kHz
  for (int i = 0; i < 2000; ++i) track.add({at_s(0.001 * i), {0.001 * i, 0.0, 0.0}});
  track.add({at_s(2.0), {2.4, 0.0, 0.0}});
  EXPECT_EQ(track.breaks(), 1u);
}

TEST(OdometryTrack, ReadsAnUnwrappedYawAsTheAngleItIs) {
  OdometryTrack track;
  track.add({at_s(0.0), {0.0, 0.0, radians(179)}});
  track.add({at_s(0.1), {0.0, 0.0, radians(181)}});
  track.add({at_s(0.2), {0.0, 0.0, radians(-177)}});
  EXPECT_EQ(track.breaks(), 0u);
  EXPECT_NEAR(track.at(at_s(0.2))->yaw, radians(-177), 1e-9);
}

}  // namespace
}  // namespace mstsl
