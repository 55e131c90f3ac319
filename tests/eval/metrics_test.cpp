#include "mstsl/eval/metrics.hpp"

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/eval/summary.hpp"

namespace mstsl {
namespace {

/// Drives along x at 1 m/s for 20 s.
Trajectory straight_truth() {
  Trajectory truth;
  for (int i = 0; i <= 200; ++i) truth.add(Stamp::from_seconds(0.1 * i), {0.1 * i, 0.0, 0.0});
  return truth;
}

/// An estimate after `seconds` that is off by `error_m` sideways; none if `error_m` is negative.
Estimate estimate_at(double seconds, double error_m, double probability = 0.9) {
  Estimate estimate;
  estimate.stamp = Stamp::from_seconds(seconds);
  estimate.travelled_m = seconds;
  if (error_m < 0.0) return estimate;
  estimate.status = LocalizationStatus::kLocalized;
  estimate.map_T_base = Pose2{seconds, error_m, 0.0};
  estimate.probability = probability;
  return estimate;
}

TEST(EvaluateRun, ARightFirstAnswerIsSuccessAndItsDistanceTheCld) {
  const auto run =
      evaluate_run({estimate_at(1.05, -1), estimate_at(3.05, 0.3), estimate_at(4.0, 0.1)}, straight_truth());
  EXPECT_TRUE(run.succeeded());
  EXPECT_DOUBLE_EQ(*run.correct_distance_m, 3.05);
  EXPECT_NEAR(run.first()->error.position_m, 0.3, 1e-9);
  EXPECT_FALSE(run.first()->tight);
  EXPECT_TRUE(run.last->tight);
}

TEST(EvaluateRun, TrueCovariancesGiveTheChiSquareOfThreeAndHalfAsWideOnesFourTimesIt) {
  Random random(5);
  Eigen::Matrix3d spread;  // a lower triangle: the error's factor
  spread << 0.1, 0.0, 0.0, 0.05, 0.08, 0.0, 0.01, -0.02, 0.03;
  std::vector<JudgedAnswer> answers, boasting;
  for (int i = 0; i < 3000; ++i) {
    Estimate estimate = estimate_at(3.0, 0.0);
    const Eigen::Vector3d error = spread * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    estimate.map_T_base = Pose2::from(Eigen::Vector2d(3.0, 0.0) + error.head<2>(), error.z());
    estimate.covariance = spread * spread.transpose();
    answers.push_back(*evaluate_run({estimate}, straight_truth()).first());
    estimate.covariance /= 4.0;
    boasting.push_back(*evaluate_run({estimate}, straight_truth()).first());
  }
  const Consistency honest = consistency(answers);
  EXPECT_NEAR(honest.mean_nees, 3.0, 0.15);
  EXPECT_NEAR(honest.median_nees, 2.37, 0.15);
  EXPECT_NEAR(honest.within_95.share(), 0.95, 0.015);
  EXPECT_NEAR(consistency(boasting).mean_nees, 4.0 * honest.mean_nees, 1e-6);
  EXPECT_LT(consistency(boasting).within_95.share(), 0.5);
}

TEST(EvaluateRun, WithoutACovarianceThereIsNoNees) {
  EXPECT_FALSE(evaluate_run({estimate_at(3.0, 0.1)}, straight_truth()).first()->nees);
  EXPECT_EQ(consistency({*evaluate_run({estimate_at(3.0, 0.1)}, straight_truth()).first()}).poses, 0u);
}

TEST(EvaluateRun, AWrongFirstAnswerIsNoSuccessThoughTheRightOneFollows) {
  const auto run = evaluate_run({estimate_at(2.0, 5.0), estimate_at(3.0, 0.1)}, straight_truth());
  EXPECT_FALSE(run.succeeded());
  EXPECT_DOUBLE_EQ(*run.correct_distance_m, 3.0);
  EXPECT_TRUE(run.last->right);
}

TEST(EvaluateRun, AnAnswerBeyondTenMetresIsAFailure) {
  const auto run = evaluate_run({estimate_at(10.01, 0.1)}, straight_truth());
  EXPECT_FALSE(run.succeeded());
  EXPECT_FALSE(run.correct_distance_m);
}

TEST(EvaluateRun, ARightPlaceWithAWrongHeadingIsWrong) {
  Estimate estimate = estimate_at(1.0, 0.0);
  estimate.map_T_base->yaw = radians(11);
  EXPECT_FALSE(evaluate_run({estimate}, straight_truth()).last->right);
}

TEST(EvaluateRun, EndingWithoutAPoseIsNoFinalAnswer) {
  const auto run = evaluate_run({estimate_at(2.0, 0.1), estimate_at(3.0, -1)}, straight_truth());
  EXPECT_FALSE(run.last);
}

TEST(EvaluateRun, EstimatesOutsideTheTruthAreCountedNotJudged) {
  const auto run = evaluate_run({estimate_at(25.0, 0.0)}, straight_truth());
  EXPECT_EQ(run.without_truth, 1u);
  EXPECT_TRUE(run.answers.empty());
}

TEST(EvaluateRun, InitialisationIsJudgedByTheNearestOfTheFirstHypotheses) {
  Estimate first = estimate_at(1.0, -1), later = estimate_at(2.0, -1);
  first.hypotheses = {{{50, 0, 0}, 0.6}, {{1, 2.5, 0}, 0.3}};
  later.hypotheses = {{{2, 0, 0}, 0.9}};
  const auto run = evaluate_run({estimate_at(0.5, -1), first, later}, straight_truth());
  ASSERT_TRUE(run.initialisation);
  EXPECT_NEAR(run.initialisation->best_error_m, 2.5, 1e-9);
  EXPECT_NEAR(run.initialisation->first_error_m, 49.0, 1e-9);
  EXPECT_TRUE(run.initialisation->succeeded);
}

TEST(EvaluateRun, CountsHowOftenTheRobotWasLost) {
  Estimate lost = estimate_at(2.0, -1);
  lost.status = LocalizationStatus::kLost;
  Estimate still_lost = lost;
  still_lost.stamp = Stamp::from_seconds(2.5);
  const auto run =
      evaluate_run({estimate_at(1.0, 0.1), lost, still_lost, estimate_at(3.0, 0.1)}, straight_truth());
  EXPECT_EQ(run.times_lost, 1u);
}

}  // namespace
}  // namespace mstsl
