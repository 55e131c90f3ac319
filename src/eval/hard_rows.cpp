#include <algorithm>
#include <functional>

#include "mstsl/eval/hard_report.hpp"

namespace mstsl {
namespace {

void add_claims(const HardRecord& record, HardRow& row) {
  if (record.first && record.first->probability >= 0.99) row.first_wrong_at_99.add(!record.first->right);
  if (record.first && record.first->probability >= 0.999) row.first_wrong_at_999.add(!record.first->right);
  if (record.kidnap) return;  // what is claimed before the carrying is noticed counts as notice, below
  row.runs_wrong_at_99.add(record.wrong_at_99 > 0);
  row.runs_wrong_at_999.add(record.wrong_at_999 > 0);
}

void add_kidnap(const KidnapOutcome& kidnap, HardRow& row) {
  if (!kidnap.localized_before) return;
  constexpr double kSoon_m = 3.0, kFound_m = 10.0;  // issue 4, item 4
  row.noticed_3m.add(kidnap.noticed_m && *kidnap.noticed_m <= kSoon_m);
  row.recovered_10m.add(kidnap.recovered_m && *kidnap.recovered_m <= kFound_m);
  row.wrong_after_kidnap.add(kidnap.wrong_again);
  if (kidnap.noticed_m) row.noticed_m.push_back(*kidnap.noticed_m);
  if (kidnap.recovered_m) row.recovered_m.push_back(*kidnap.recovered_m);
}

void add(const HardRecord& record, HardRow& row) {
  ++row.runs;
  row.driven_km += 1e-3 * record.driven_m;
  row.right_km += 1e-3 * record.right_m;
  row.success.add(record.succeeded());
  row.tight.add(record.succeeded() && record.first->tight);
  row.answered.add(record.first.has_value());
  row.right_at_end.add(record.last && record.last->right);
  add_claims(record, row);
  if (record.correct_distance_m) row.correct_distance_m.push_back(*record.correct_distance_m);
  if (record.first && record.first->right && record.first_s) row.time_to_fix_s.push_back(*record.first_s);
  if (record.first && record.first->right && !record.kidnap)
    for (const JudgedAnswer& answer : record.sample) {
      row.error_m.push_back(answer.error.position_m);
      row.error_rad.push_back(answer.error.yaw_rad);
    }
  row.false_alarms += record.false_alarms;
  row.times_lost += record.times_lost;
  if (record.kidnap) add_kidnap(*record.kidnap, row);
  row.searching.add(record.searching);
  row.tracking.add(record.tracking);
}

HardRow row_of(const std::vector<HardRecord>& records, const HardKey& which) {
  const auto fits = [](const std::string& wanted, const std::string& is) {
    return wanted == "*" || wanted == is;
  };
  HardRow row;
  row.method = which.method, row.world = which.world, row.disturbance = which.disturbance;
  std::vector<JudgedAnswer> firsts, thinned;
  for (const HardRecord& record : records) {
    if (!fits(which.method, record.key.method) || !fits(which.world, record.key.world) ||
        !fits(which.disturbance, record.key.disturbance))
      continue;
    add(record, row);
    if (record.first) firsts.push_back(*record.first);
    thinned.insert(thinned.end(), record.sample.begin(), record.sample.end());
  }
  row.first_answers = calibrate(firsts);
  row.thinned_answers = calibrate(thinned);
  row.covariances = consistency(thinned);
  return row;
}

/// The values of a key's part, in their first order.
std::vector<std::string> values_of(const std::vector<HardRecord>& records, std::string HardKey::*part) {
  std::vector<std::string> values;
  for (const HardRecord& record : records)
    if (std::find(values.begin(), values.end(), record.key.*part) == values.end())
      values.push_back(record.key.*part);
  return values;
}

}  // namespace

std::vector<HardRow> hard_rows(const std::vector<HardRecord>& records) {
  const auto worlds = values_of(records, &HardKey::world);
  const auto disturbances = values_of(records, &HardKey::disturbance);
  std::vector<HardRow> rows;
  for (const std::string& method : values_of(records, &HardKey::method)) {
    const auto push = [&](const std::string& world, const std::string& disturbance) {
      rows.push_back(row_of(records, {"", world, disturbance, method, 0}));
    };
    push("*", "*");
    for (const std::string& world : worlds) push(world, "*");
    for (const std::string& disturbance : disturbances) push("*", disturbance);
    for (const std::string& world : worlds)
      for (const std::string& disturbance : disturbances) push(world, disturbance);
  }
  return rows;
}

}  // namespace mstsl
