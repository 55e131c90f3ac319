#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "mstsl/eval/hard_report.hpp"

namespace mstsl {
namespace {

constexpr std::array<std::pair<const char*, Rate HardRow::*>, 8> kRates{
    {{"success", &HardRow::success},
     {"tight_success", &HardRow::tight},
     {"answered", &HardRow::answered},
     {"right_at_end", &HardRow::right_at_end},
     {"first_wrong_at_0.99", &HardRow::first_wrong_at_99},
     {"first_wrong_at_0.999", &HardRow::first_wrong_at_999},
     {"runs_wrong_at_0.99", &HardRow::runs_wrong_at_99},
     {"runs_wrong_at_0.999", &HardRow::runs_wrong_at_999}}};

constexpr std::array<std::pair<const char*, std::vector<double> HardRow::*>, 4> kValues{
    {{"correct_distance_m", &HardRow::correct_distance_m},
     {"time_to_fix_s", &HardRow::time_to_fix_s},
     {"error_after_fix_m", &HardRow::error_m},
     {"error_after_fix_rad", &HardRow::error_rad}}};

/// Empty where there is no such number.
std::string cell(double value) { return std::isfinite(value) ? fmt::format(",{:.6g}", value) : ","; }

std::string head() {
  std::string line = "method,world,disturbance,runs,driven_km";
  for (const auto& [name, rate] : kRates) line += fmt::format(",{0},{0}_of,{0}_low_95,{0}_high_95", name);
  for (const auto& [name, values] : kValues) line += fmt::format(",{0}_median,{0}_p95", name);
  return line +
         ",brier,nees_mean,nees_within_95,false_alarms,right_km,cpu_searching_p99_ms,cpu_tracking_median_"
         "ms\n";
}

std::string line(const HardRow& row) {
  std::string line =
      fmt::format("{},{},{},{}", row.method, row.world, row.disturbance, row.runs) + cell(row.driven_km);
  for (const auto& [name, rate] : kRates) {
    const Interval interval = wilson_interval(row.*rate);
    line +=
        fmt::format(",{},{}", (row.*rate).hits, (row.*rate).of) + cell(interval.low) + cell(interval.high);
  }
  for (const auto& [name, values] : kValues)
    line += cell(quantile(row.*values, 0.5)) + cell(quantile(row.*values, 0.95));
  return line + cell(row.first_answers.brier) + cell(row.covariances.mean_nees) +
         cell(row.covariances.within_95.of > 0 ? row.covariances.within_95.share() : std::nan("")) +
         fmt::format(",{}", row.false_alarms) + cell(row.right_km) + cell(row.searching.quantile_ms(0.99)) +
         cell(row.tracking.quantile_ms(0.5)) + "\n";
}

}  // namespace

std::string hard_csv(const std::vector<HardRecord>& records) {
  std::string csv = head();
  for (const HardRow& row : hard_rows(records)) csv += line(row);
  return csv;
}

}  // namespace mstsl
