#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mstsl/eval/hard_record.hpp"
#include "mstsl/eval/summary.hpp"

namespace mstsl {

/// Runs of one method under one condition, summed up. Quantiles are NaN without values.
struct HardRow {
  std::string method, world, disturbance;  ///< "*" where all are taken together
  std::size_t runs = 0;
  double driven_km = 0.0, right_km = 0.0;
  Rate success, tight, answered, right_at_end;
  Rate first_wrong_at_99, first_wrong_at_999;  ///< of the first answers claimed so: the wrong ones
  Rate runs_wrong_at_99, runs_wrong_at_999;    ///< of all runs: with any wrong answer claimed so
  std::vector<double> correct_distance_m, time_to_fix_s;
  std::vector<double> error_m, error_rad;  ///< of right first answers' runs: thinned answers from there on
  Calibration first_answers, thinned_answers;
  Consistency covariances;  ///< of the thinned answers that are right
  std::size_t false_alarms = 0, times_lost = 0;
  Rate noticed_3m, recovered_10m, wrong_after_kidnap;  ///< of the kidnapped that were localized before
  std::vector<double> noticed_m, recovered_m;
  CostHistogram searching, tracking;
};

/// Rows for each method: over everything, by world, by disturbance, and each world with each disturbance.
std::vector<HardRow> hard_rows(const std::vector<HardRecord>& records);

/// Tables for people.
std::string hard_text(const std::vector<HardRecord>& records);

/// The rows with all their rates and bounds, for a spreadsheet.
std::string hard_csv(const std::vector<HardRecord>& records);

/// How the runs came to be: stands at the head of the JSON.
struct HardHead {
  std::string commit, build;
  std::uint64_t seed = 0;
  double peak_memory_mb = 0.0;  ///< of the whole process, all threads' runs together
};

/// Everything but cost: the same bytes for the same runs. NaN becomes null.
std::string hard_json(const std::vector<HardRecord>& records, const HardHead& head);
/// CPU time and memory, which no two runs share.
std::string hard_cost_json(const std::vector<HardRecord>& records, const HardHead& head);

}  // namespace mstsl
