#include "mstsl/eval/hard_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(const Rate& rate) {
  if (rate.of == 0) return fmt::format("{:>19}", "-");
  const Interval i = wilson_interval(rate);
  return fmt::format("{:>5.1f} [{:>5.1f},{:>6.1f}]", 100 * rate.share(), 100 * i.low, 100 * i.high);
}

/// "wrong/of": the counts behind a rare event's rate.
std::string counts(const Rate& rate) { return fmt::format("{:>4}/{:<5}", rate.hits, rate.of); }

std::string pair(const std::vector<double>& values, double scale) {
  if (values.empty()) return fmt::format("{:>12}", "-");
  return fmt::format("{:>5.2f} /{:>5.2f}", scale * quantile(values, 0.5), scale * quantile(values, 0.95));
}

std::string table(const std::vector<HardRow>& rows) {
  std::string text = fmt::format(
      "{:<16} {:<15} {:<16} {:>5} {:>21} {:>7} {:>6} {:>10} {:>10} {:>10} {:>13} {:>13} {:>13} {:>13}\n",
      "method", "world", "disturbance", "runs", "success % [95 %]", "tight %", "silent", "1st>.999",
      "any>.999", "any>.99", "CLD m 50/95", "fix s 50/95", "err cm 50/95", "deg 50/95");
  for (const HardRow& r : rows)
    text +=
        fmt::format("{:<16} {:<15} {:<16} {:>5} {:>21} {:>7.1f} {:>6} {} {} {} {:>13} {:>13} {:>13} {:>13}\n",
                    r.method, r.world, r.disturbance, r.runs, percent(r.success), 100 * r.tight.share(),
                    r.runs - r.answered.hits, counts(r.first_wrong_at_999), counts(r.runs_wrong_at_999),
                    counts(r.runs_wrong_at_99), pair(r.correct_distance_m, 1), pair(r.time_to_fix_s, 1),
                    pair(r.error_m, 100), pair(r.error_rad, degrees(1.0)));
  return text;
}

std::string kidnap_text(const HardRow& r) {
  if (r.noticed_3m.of == 0) return "";
  return fmt::format(
      "  kidnapped while localized rightly: {}; noticed within 3 m {} %, m 50/95 {}; right again within 10 m "
      "{} "
      "%, m 50/95 {}; wrong pose after notice {} %\n",
      r.noticed_3m.of, percent(r.noticed_3m), pair(r.noticed_m, 1), percent(r.recovered_10m),
      pair(r.recovered_m, 1), percent(r.wrong_after_kidnap));
}

std::string method_text(const HardRow& r) {
  std::string text = fmt::format("{}: {} runs, {:.2f} km, wrong first claims at >= 0.999: {} % ({}/{})\n",
                                 r.method, r.runs, r.driven_km, percent(r.first_wrong_at_999),
                                 r.first_wrong_at_999.hits, r.first_wrong_at_999.of);
  text += fmt::format("  right poses withdrawn: {} in {:.2f} km driven with a right pose; lost {} times\n",
                      r.false_alarms, r.right_km, r.times_lost);
  text += fmt::format("  reliability of first answers (Brier {:.4f}):", r.first_answers.brier);
  for (const ReliabilityBin& bin : r.first_answers.bins)
    text += fmt::format("  {:.3f} -> {:.3f} ({})", bin.mean_claim, bin.right.share(), bin.right.of);
  text += "\n";
  if (r.covariances.poses > 0)
    text += fmt::format(
        "  covariances of right poses: NEES mean {:.2f} (3 if true), median {:.2f} (2.37), within 95 % {} "
        "%\n",
        r.covariances.mean_nees, r.covariances.median_nees, percent(r.covariances.within_95));
  text += kidnap_text(r);
  for (const auto& [what, cost] : {std::pair{"searching", &r.searching}, {"tracking", &r.tracking}})
    text +=
        fmt::format("  CPU per scan {}: 50 % {:.2f} ms, 95 % {:.2f}, 99 % {:.2f}, worst {:.1f} ({} scans)\n",
                    what, cost->quantile_ms(0.5), cost->quantile_ms(0.95), cost->quantile_ms(0.99),
                    cost->max_ms(), cost->count());
  return text;
}

Json json_of(const Rate& rate) {
  const Interval i = wilson_interval(rate);
  return {{"hits", rate.hits}, {"of", rate.of}, {"wilson_95", {i.low, i.high}}};
}

Json quantiles(const std::vector<double>& values) {
  return {{"count", values.size()},
          {"median", quantile(values, 0.5)},
          {"p95", quantile(values, 0.95)},
          {"max", quantile(values, 1.0)}};
}

Json json_of(const Calibration& calibration) {
  Json bins = Json::array();
  for (const ReliabilityBin& bin : calibration.bins)
    bins.push_back({{"low", bin.low},
                    {"high", bin.high},
                    {"mean_claim", bin.mean_claim},
                    {"right", json_of(bin.right)}});
  return {{"brier", calibration.brier}, {"bins", bins}};
}

Json json_of(const HardRow& r) {
  return {{"method", r.method},
          {"world", r.world},
          {"disturbance", r.disturbance},
          {"runs", r.runs},
          {"driven_km", r.driven_km},
          {"right_km", r.right_km},
          {"success", json_of(r.success)},
          {"tight_success", json_of(r.tight)},
          {"answered", json_of(r.answered)},
          {"right_at_end", json_of(r.right_at_end)},
          {"first_wrong_at_0.99", json_of(r.first_wrong_at_99)},
          {"first_wrong_at_0.999", json_of(r.first_wrong_at_999)},
          {"runs_wrong_at_0.99", json_of(r.runs_wrong_at_99)},
          {"runs_wrong_at_0.999", json_of(r.runs_wrong_at_999)},
          {"correct_distance_m", quantiles(r.correct_distance_m)},
          {"time_to_fix_s", quantiles(r.time_to_fix_s)},
          {"error_after_fix_m", quantiles(r.error_m)},
          {"error_after_fix_rad", quantiles(r.error_rad)},
          {"first_answers", json_of(r.first_answers)},
          {"thinned_answers", json_of(r.thinned_answers)},
          {"nees",
           {{"poses", r.covariances.poses},
            {"mean", r.covariances.mean_nees},
            {"median", r.covariances.median_nees},
            {"within_95", json_of(r.covariances.within_95)}}},
          {"false_alarms", r.false_alarms},
          {"times_lost", r.times_lost},
          {"kidnap",
           {{"noticed_within_3_m", json_of(r.noticed_3m)},
            {"recovered_within_10_m", json_of(r.recovered_10m)},
            {"wrong_after_notice", json_of(r.wrong_after_kidnap)},
            {"noticed_m", quantiles(r.noticed_m)},
            {"recovered_m", quantiles(r.recovered_m)}}}};
}

Json json_of(const CostHistogram& cost) {
  return {{"scans", cost.count()},
          {"median_ms", cost.quantile_ms(0.5)},
          {"p95_ms", cost.quantile_ms(0.95)},
          {"p99_ms", cost.quantile_ms(0.99)},
          {"max_ms", cost.max_ms()}};
}

Json head_json(const std::vector<HardRecord>& records, const HardHead& head) {
  return {{"protocol", "hard"},    {"set", records.empty() ? "" : records.front().key.set},
          {"commit", head.commit}, {"build", head.build},
          {"seed", head.seed},     {"options", records.empty() ? "" : records.front().options}};
}

}  // namespace

std::string hard_text(const std::vector<HardRecord>& records) {
  const std::vector<HardRow> rows = hard_rows(records);
  std::string text =
      table(rows) +
      "\nsuccess: first pose within 0.5 m and 10 deg, after at most 10 m; tight: 0.2 m and 3 deg. "
      "1st>.999: wrong/all first poses claimed so. any>.999: runs with any wrong pose claimed "
      "so/runs. Errors: all poses of runs whose first pose was right, thinned.\n\n";
  double simulation_ms = 0.0;
  for (const HardRecord& record : records) simulation_ms += record.simulation_ms;
  for (const HardRow& row : rows)
    if (row.world == "*" && row.disturbance == "*") text += method_text(row);
  if (!records.empty())
    text +=
        fmt::format("simulation: {:.0f} ms CPU a run\n", simulation_ms / static_cast<double>(records.size()));
  return text;
}

std::string hard_json(const std::vector<HardRecord>& records, const HardHead& head) {
  Json json = head_json(records, head);
  json["rows"] = Json::array();
  for (const HardRow& row : hard_rows(records)) json["rows"].push_back(json_of(row));
  return json.dump(1) + "\n";
}

std::string hard_cost_json(const std::vector<HardRecord>& records, const HardHead& head) {
  Json json = head_json(records, head);
  json["peak_memory_mb"] = head.peak_memory_mb;
  json["rows"] = Json::array();
  for (const HardRow& row : hard_rows(records))
    json["rows"].push_back({{"method", row.method},
                            {"world", row.world},
                            {"disturbance", row.disturbance},
                            {"searching", json_of(row.searching)},
                            {"tracking", json_of(row.tracking)}});
  return json.dump(1) + "\n";
}

}  // namespace mstsl
