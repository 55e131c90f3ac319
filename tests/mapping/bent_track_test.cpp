#include "mstsl/mapping/bent_track.hpp"

#include <gtest/gtest.h>

namespace mstsl {
namespace {

std::vector<TimedPose> straight() {
  std::vector<TimedPose> track;
  for (int i = 0; i <= 20; ++i) track.push_back({Stamp::from_seconds(0.5 * i), {0.1 * i, 0, 0}});
  return track;
}

TEST(BentTrack, MeetsItsKnotsAndIsOdometryElsewhere) {
  const std::vector<TimedPose> track = straight();
  const std::vector<TrackKnot> knots{{Stamp::from_seconds(2.0), {0.4, 0, 0}, {10, 5, 1.5}},
                                     {Stamp::from_seconds(6.25), {1.25, 0, 0}, {10.2, 5.9, 1.6}}};
  const Trajectory bent = bent_track(track, knots);
  EXPECT_EQ(bent.size(), track.size() + 1);  // the second knot lies between two readings
  for (const TrackKnot& knot : knots) EXPECT_LT(distance(*bent.at(knot.stamp, 1.0), knot.map_T_base), 1e-9);
  const Pose2 before = knots[0].map_T_base * between(knots[0].track_T_base, track[0].pose);
  EXPECT_LT(distance(bent.front().pose, before), 1e-9);
  const Pose2 after = knots[1].map_T_base * between(knots[1].track_T_base, track[20].pose);
  EXPECT_LT(distance(bent.back().pose, after), 1e-9);
}

TEST(BentTrack, OneKnotIsARigidMotion) {
  const std::vector<TimedPose> track = straight();
  const std::vector<TrackKnot> knots{{Stamp::from_seconds(5.0), {1.0, 0, 0}, {3, 3, -2}}};
  const Trajectory bent = bent_track(track, knots);
  for (std::size_t i = 0; i + 1 < track.size(); ++i) {
    const auto a = *bent.at(track[i].stamp, 1.0), b = *bent.at(track[i + 1].stamp, 1.0);
    EXPECT_LT(distance(between(a, b), between(track[i].pose, track[i + 1].pose)), 1e-9);
  }
}

}  // namespace
}  // namespace mstsl
