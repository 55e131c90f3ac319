#include "mstsl/eval/summary.hpp"

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

JudgedAnswer answer(double probability, bool right, double travelled_m = 3.0) {
  return {travelled_m, probability, {right ? 0.1 : 9.0, 0.0}, right, right};
}

RunEvaluation run_of(std::vector<JudgedAnswer> answers) {
  RunEvaluation run;
  for (const JudgedAnswer& a : answers)
    if (a.right && !run.correct_distance_m) run.correct_distance_m = a.travelled_m;
  if (!answers.empty()) run.last = answers.back();
  run.answers = std::move(answers);
  return run;
}

TEST(Calibrate, ClaimsDrawnTruthfullyComeOutReliable) {
  Random random(3);
  std::vector<JudgedAnswer> answers;
  for (int i = 0; i < 100'000; ++i) {
    const double p = random.uniform();
    answers.push_back(answer(p, random.chance(p)));
  }
  const Calibration calibration = calibrate(answers);
  EXPECT_GE(calibration.bins.size(), 6u);
  for (const ReliabilityBin& bin : calibration.bins) EXPECT_NEAR(bin.right.share(), bin.mean_claim, 0.05);
  EXPECT_NEAR(calibration.brier, 1.0 / 6.0, 0.005);  // the mean of p (1 - p)
}

TEST(Calibrate, CountsTheWrongAmongTheSure) {
  const Calibration calibration =
      calibrate({answer(0.995, true), answer(0.995, false), answer(0.9995, false), answer(1.0, true)});
  EXPECT_EQ(calibration.wrong_at_99.hits, 2u);
  EXPECT_EQ(calibration.wrong_at_99.of, 4u);
  EXPECT_EQ(calibration.wrong_at_999.hits, 1u);
  EXPECT_EQ(calibration.wrong_at_999.of, 2u);
  EXPECT_EQ(calibration.bins.back().right.of, 2u) << "a claim of exactly 1 belongs to the last bin";
}

TEST(Summarise, CountsEveryRunAlsoThoseWithoutAnAnswer) {
  const Summary summary =
      summarise({run_of({answer(0.9, true)}), run_of({answer(0.9, false), answer(0.9, true, 6.0)}),
                 run_of({}), run_of({answer(0.999, false)})});
  EXPECT_EQ(summary.success.hits, 1u);
  EXPECT_EQ(summary.success.of, 4u);
  EXPECT_EQ(summary.answered.hits, 3u);
  EXPECT_EQ(summary.final_success.hits, 2u);
  EXPECT_EQ(summary.runs_wrong_at_999.hits, 1u);
  EXPECT_EQ(summary.initialised.hits, 0u);
  EXPECT_EQ(summary.correct_distance_m.count, 2u);
  EXPECT_EQ(summary.first_answers.wrong_at_99.of, 1u);
}

}  // namespace
}  // namespace mstsl
