#include "mstsl/eval/trajectory_error.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

/// Twice round a circle of 10 m across, a pose every 0.2 m.
std::vector<Pose2> circles() {
  std::vector<Pose2> poses{{5, 0, kPi / 2}};
  for (int i = 0; i < 314; ++i) poses.push_back(poses.back() * Pose2{0.2, 0.004, 0.04});
  return poses;
}

std::vector<TimedPose> timed(const std::vector<Pose2>& poses, const Pose2& map_T_true) {
  std::vector<TimedPose> track;
  for (std::size_t i = 0; i < poses.size(); ++i)
    track.push_back({Stamp::from_seconds(0.1 * static_cast<double>(i)), map_T_true * poses[i]});
  return track;
}

TEST(TrajectoryError, ARigidMotionIsNoError) {
  const std::vector<Pose2> truth = circles();
  const Pose2 map_T_true{3, -7, 2.1};
  const std::vector<TimedPose> track = timed(truth, map_T_true);
  const TrajectoryError error = trajectory_error(track, truth);
  EXPECT_LT(error.max_m, 1e-9);
  EXPECT_LT(distance(error.true_T_map, inverse(map_T_true)), 1e-9);
  EXPECT_LT(local_errors(track, truth).translation_m.max, 1e-9);
  EXPECT_LT(loop_errors(track, truth).rotation_deg.max, 1e-6);
}

TEST(TrajectoryError, AScaleShowsInRelationsAndALoopThatDoesNotCloseShowsInLoops) {
  const std::vector<Pose2> truth = circles();
  std::vector<TimedPose> longer = timed(truth, {});
  for (TimedPose& at : longer) at.pose = Pose2::from(1.02 * at.pose.position(), at.pose.yaw);
  EXPECT_NEAR(local_errors(longer, truth).translation_m.mean, 0.02, 0.003);
  EXPECT_NEAR(trajectory_error(longer, truth).rms_m, 0.1, 0.01);

  std::vector<TimedPose> drifting = timed(truth, {});
  for (std::size_t i = truth.size() / 2; i < truth.size(); ++i) drifting[i].pose.x += 0.5;
  const RelationErrors loops = loop_errors(drifting, truth);
  EXPECT_GT(loops.translation_m.count, 100U);
  EXPECT_NEAR(loops.translation_m.median, 0.5, 0.01);
  EXPECT_NEAR(local_errors(drifting, truth).translation_m.median, 0.0, 1e-9);
}

TEST(TrajectoryError, HasNoRelationsWhereNothingMoves) {
  const std::vector<Pose2> truth(5, Pose2{1, 2, 3});
  EXPECT_EQ(local_errors(timed(truth, {}), truth).translation_m.count, 0U);
  EXPECT_EQ(loop_errors(timed(truth, {}), truth).translation_m.count, 0U);
}

}  // namespace
}  // namespace mstsl
