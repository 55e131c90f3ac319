#include "mstsl/eval/summary.hpp"

#include <algorithm>

namespace mstsl {
namespace {

/// Finer towards 1, where the claims that robots act on lie.
constexpr std::array<double, 8> kBinEdges{0.0, 0.5, 0.8, 0.9, 0.95, 0.99, 0.999, 1.0 + 1e-9};

ReliabilityBin bin_of(const std::vector<JudgedAnswer>& answers, double low, double high) {
  ReliabilityBin bin{low, std::min(high, 1.0), 0.0, {}};
  for (const JudgedAnswer& answer : answers) {
    if (answer.probability < low || answer.probability >= high) continue;
    bin.right.add(answer.right);
    bin.mean_claim += answer.probability;
  }
  if (bin.right.of > 0) bin.mean_claim /= static_cast<double>(bin.right.of);
  return bin;
}

Rate wrong_at(const std::vector<JudgedAnswer>& answers, double claim) {
  Rate wrong;
  for (const JudgedAnswer& answer : answers)
    if (answer.probability >= claim) wrong.add(!answer.right);
  return wrong;
}

/// The values of all runs, gathered.
struct Gathered {
  std::vector<double> initial_m, first_m, first_yaw, final_m, final_yaw, distance_m;
  std::vector<JudgedAnswer> firsts, all;
};

void gather(const RunEvaluation& run, Gathered& to) {
  if (run.initialisation) to.initial_m.push_back(run.initialisation->best_error_m);
  if (const JudgedAnswer* first = run.first()) {
    to.first_m.push_back(first->error.position_m);
    to.first_yaw.push_back(first->error.yaw_rad);
    to.firsts.push_back(*first);
  }
  if (run.last) {
    to.final_m.push_back(run.last->error.position_m);
    to.final_yaw.push_back(run.last->error.yaw_rad);
  }
  if (run.correct_distance_m) to.distance_m.push_back(*run.correct_distance_m);
  to.all.insert(to.all.end(), run.answers.begin(), run.answers.end());
}

void count(const RunEvaluation& run, const Criteria& criteria, Summary& summary) {
  const auto& initial = run.initialisation;
  summary.initialised.add(initial && initial->succeeded);
  summary.initialised_first.add(initial && initial->first_error_m <= criteria.initial_bound_m);
  summary.answered.add(run.first() != nullptr);
  summary.success.add(run.succeeded());
  summary.tight_success.add(run.succeeded() && run.first()->tight);
  summary.final_success.add(run.last && run.last->right);
  summary.final_tight.add(run.last && run.last->tight);
  summary.runs_wrong_at_99.add(wrong_at(run.answers, 0.99).hits > 0);
  summary.runs_wrong_at_999.add(wrong_at(run.answers, 0.999).hits > 0);
  summary.times_lost += run.times_lost;
  summary.without_truth += run.without_truth;
}

}  // namespace

Calibration calibrate(const std::vector<JudgedAnswer>& answers) {
  Calibration calibration;
  for (std::size_t i = 0; i + 1 < kBinEdges.size(); ++i) {
    const ReliabilityBin bin = bin_of(answers, kBinEdges[i], kBinEdges[i + 1]);
    if (bin.right.of > 0) calibration.bins.push_back(bin);
  }
  for (const JudgedAnswer& answer : answers) {
    const double miss = answer.probability - (answer.right ? 1.0 : 0.0);
    calibration.brier += miss * miss / static_cast<double>(answers.size());
  }
  calibration.wrong_at_99 = wrong_at(answers, 0.99);
  calibration.wrong_at_999 = wrong_at(answers, 0.999);
  return calibration;
}

Consistency consistency(const std::vector<JudgedAnswer>& answers) {
  constexpr double kBound95 = 7.815;  // chi-square, 3 degrees of freedom
  std::vector<double> nees;
  Consistency result;
  for (const JudgedAnswer& answer : answers) {
    if (!answer.right || !answer.nees) continue;
    nees.push_back(*answer.nees);
    result.within_95.add(*answer.nees <= kBound95);
  }
  const Spread spread = spread_of(nees);
  result.poses = spread.count;
  result.mean_nees = spread.mean;
  result.median_nees = spread.median;
  return result;
}

Summary summarise(const std::vector<RunEvaluation>& runs, const Criteria& criteria) {
  Summary summary;
  summary.runs = runs.size();
  Gathered gathered;
  for (const RunEvaluation& run : runs) {
    count(run, criteria, summary);
    gather(run, gathered);
  }
  summary.initial_error_m = spread_of(gathered.initial_m);
  summary.first_error_m = spread_of(gathered.first_m);
  summary.first_error_yaw_rad = spread_of(gathered.first_yaw);
  summary.final_error_m = spread_of(gathered.final_m);
  summary.final_error_yaw_rad = spread_of(gathered.final_yaw);
  summary.correct_distance_m = spread_of(gathered.distance_m);
  summary.first_answers = calibrate(gathered.firsts);
  summary.all_answers = calibrate(gathered.all);
  summary.covariances = consistency(gathered.all);
  return summary;
}

}  // namespace mstsl
