#include "mstsl/eval/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace mstsl {
namespace {

std::optional<double> nees_of(const Estimate& estimate, const Pose2& truth) {
  const Eigen::LLT<Eigen::Matrix3d> factor(estimate.covariance);
  if (!estimate.covariance.allFinite() || factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::Vector3d error = difference(truth, *estimate.map_T_base);
  return error.dot(factor.solve(error));
}

JudgedAnswer judge(const Estimate& estimate, const Pose2& truth, const Criteria& criteria) {
  const PoseError error = error_between(*estimate.map_T_base, truth);
  return {estimate.travelled_m,          estimate.probability,        error,
          criteria.success.holds(error), criteria.tight.holds(error), nees_of(estimate, truth)};
}

JudgedInitialisation judge_initialisation(const std::vector<Hypothesis>& hypotheses, const Pose2& truth,
                                          const Criteria& criteria) {
  JudgedInitialisation judged{hypotheses.size(), std::numeric_limits<double>::infinity(),
                              distance(hypotheses.front().map_T_base, truth), false};
  for (const Hypothesis& hypothesis : hypotheses)
    judged.best_error_m = std::min(judged.best_error_m, distance(hypothesis.map_T_base, truth));
  judged.succeeded = judged.best_error_m <= criteria.initial_bound_m;
  return judged;
}

void judge_estimate(const Estimate& estimate, const Pose2& truth, const Criteria& criteria,
                    RunEvaluation& run) {
  if (!run.initialisation && !estimate.hypotheses.empty())
    run.initialisation = judge_initialisation(estimate.hypotheses, truth, criteria);
  run.last.reset();
  if (!estimate.map_T_base) return;
  run.last = judge(estimate, truth, criteria);
  run.answers.push_back(*run.last);
  if (run.last->right && !run.correct_distance_m && estimate.travelled_m <= criteria.max_distance_m)
    run.correct_distance_m = estimate.travelled_m;
}

}  // namespace

PoseError error_between(const Pose2& estimated, const Pose2& truth) {
  return {distance(estimated, truth), std::abs(angle_between(truth.yaw, estimated.yaw))};
}

bool RunEvaluation::succeeded() const {
  return first() != nullptr && first()->right && correct_distance_m.has_value();
}

RunEvaluation evaluate_run(const std::vector<Estimate>& estimates, const Trajectory& truth,
                           const Criteria& criteria) {
  RunEvaluation run;
  LocalizationStatus last = LocalizationStatus::kSearching;
  for (const Estimate& estimate : estimates) {
    ++run.estimates;
    if (estimate.status == LocalizationStatus::kLost && last != LocalizationStatus::kLost) ++run.times_lost;
    last = estimate.status;
    if (const std::optional<Pose2> true_pose = truth.at(estimate.stamp, criteria.max_truth_gap_s))
      judge_estimate(estimate, *true_pose, criteria, run);
    else
      ++run.without_truth;
  }
  return run;
}

}  // namespace mstsl
