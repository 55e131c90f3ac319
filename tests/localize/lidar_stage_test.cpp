#include "mstsl/localize/lidar_stage.hpp"

#include <numeric>

#include <gtest/gtest.h>

#include "hand_made_world.hpp"

namespace mstsl {
namespace {

class LidarStageTest : public testing::Test {
 protected:
  static InitialHypothesis at(const Pose2& pose, double probability) {
    return {pose, Eigen::Vector3d(0.04, 0.04, 1e-3).asDiagonal(), probability, 0.0};
  }

  /// Drives straight from `from` in steps of 0.1 m and lets the stage see it.
  void drive(LidarStage& stage, const Pose2& from, double length_m) {
    Pose2 pose = from;
    for (int i = 0; i <= static_cast<int>(length_m / 0.1 + 0.5); ++i) {
      const Pose2 step = i == 0 ? Pose2{} : Pose2{0.1, 0, 0};
      pose = pose * step;
      stage.observe(
          beam_returns(world.scan_at({}, pose, Eigen::Isometry3d::Identity()), Eigen::Isometry3d::Identity()),
          step);
    }
  }

  test::HandMadeWorld world;
  LidarStageOptions options;
  Pose2 start{4.0, 1.0, 0.0};  // in the southern corridor, heading east
};

TEST_F(LidarStageTest, TheTrueHypothesisSurvivesAndIsRefined) {
  LidarStage stage(world.maps, {at({4.3, 0.9, 0.02}, 0.9)}, {}, options);
  drive(stage, start, 3.0);
  ASSERT_FALSE(stage.hypotheses()[0].rejected);
  EXPECT_LT(distance(stage.hypotheses()[0].map_T_base, {7.0, 1.0, 0.0}), 0.05);
  EXPECT_GT(stage.hypotheses()[0].score, 0.95);
  ASSERT_TRUE(stage.answer());
  EXPECT_LT(distance(stage.answer()->map_T_base, {7.0, 1.0, 0.0}), 0.05);
}

TEST_F(LidarStageTest, AHypothesisBeyondTheMapIsRemovedForThat) {
  options.match.search.min_score = 0.0;
  options.low_scores_to_reject = 1000;
  LidarStage stage(world.maps, {at({4.0, -2.0, 0.0}, 0.5)}, {}, options);
  drive(stage, start, 0.5);
  EXPECT_EQ(stage.hypotheses()[0].rejected, Rejection::kOutOfMap);
  EXPECT_TRUE(stage.all_rejected());
}

TEST_F(LidarStageTest, AHypothesisThatDrivesThroughAWallIsRemovedForThat) {
  options.match.search.min_score = 0.0;
  options.low_scores_to_reject = 1000;
  LidarStage stage(world.maps, {at({10.0, 1.0, radians(90)}, 0.5)}, {}, options);
  drive(stage, start, 4.0);
  EXPECT_EQ(stage.hypotheses()[0].rejected, Rejection::kCrossesWall);
  EXPECT_GT(stage.hypotheses()[0].rejected_after_m, 0.0);
}

TEST_F(LidarStageTest, AHypothesisWhoseScansDoNotFitIsRemovedForThat) {
  LidarStage stage(world.maps, {at({1.0, 3.0, 0.0}, 0.5)}, {},
                   options);  // the western corridor, looking at its wall
  drive(stage, start, 0.6);
  EXPECT_EQ(stage.hypotheses()[0].rejected, Rejection::kLowScore);
}

TEST_F(LidarStageTest, WeightsAreSharesThatLeaveRoomForNoneOfThese) {
  LidarStage stage(world.maps, {at({4.1, 1.0, 0}, 0.5), at({20.0, 9.0, kPi}, 0.3), at({4.0, -3.0, 0}, 0.1)},
                   {}, options);
  drive(stage, start, 2.0);
  const std::vector<double> weights = stage.weights();
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  EXPECT_LT(sum, 1.0);
  EXPECT_LE(sum, options.max_probability + 1e-12);
  EXPECT_EQ(weights[2], 0.0) << "removed";
  EXPECT_GT(weights[0], weights[1]);
}

TEST_F(LidarStageTest, NoAnswerComesBeforeTheLeastDistance) {
  LidarStage stage(world.maps, {at(start, 1.0)}, {}, options);
  drive(stage, start, options.min_distance_m - 0.2);
  EXPECT_FALSE(stage.answer());
}

TEST_F(LidarStageTest, TwinsOfEqualWeightAreAnsweredOnlyAtTheAnswerDistance) {
  LidarStage stage(world.maps, {at({8.0, 1.0, 0}, 0.45), at({8.05, 1.0, 0}, 0.45)}, {}, options);
  drive(stage, {8.0, 1.0, 0.0}, options.answer_distance_m - 1.0);
  EXPECT_FALSE(stage.answer());
  const std::vector<double> weights = stage.weights();
  EXPECT_LT(*std::max_element(weights.begin(), weights.end()), options.answer_share);
}

TEST_F(LidarStageTest, BlindScansMoveTheHypothesesByOdometryAlone) {
  LidarStage stage(world.maps, {at(start, 1.0)}, {}, options);
  drive(stage, start, 1.0);
  for (int i = 0; i < 5; ++i) stage.observe({}, {0.1, 0, 0});
  EXPECT_FALSE(stage.hypotheses()[0].rejected);
  drive(stage, {5.5, 1.0, 0.0}, 0.5);
  EXPECT_LT(distance(stage.hypotheses()[0].map_T_base, {6.0, 1.0, 0.0}), 0.05);
}

}  // namespace
}  // namespace mstsl
