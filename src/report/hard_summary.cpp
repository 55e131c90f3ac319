#include <algorithm>

#include <nlohmann/json.hpp>

#include "mstsl/eval/statistics.hpp"
#include "mstsl/report/page.hpp"

namespace mstsl::report {
namespace {

using Json = nlohmann::ordered_json;

Json curves_json(const HardRow& row) {
  std::vector<double> ways_m = row.correct_distance_m;
  std::ranges::sort(ways_m);
  constexpr int kSteps = 200;
  Json errors_m = Json::array(), reliability = Json::array();
  if (!row.error_m.empty())
    for (int i = 0; i <= kSteps; ++i) errors_m.push_back(quantile(row.error_m, i / double{kSteps}));
  for (const ReliabilityBin& bin : row.first_answers.bins)
    if (bin.right.of > 0)
      reliability.push_back(
          {{"mean_claim", bin.mean_claim}, {"right", bin.right.share()}, {"of", bin.right.of}});
  return {{"method", row.method},
          {"runs", row.runs},
          {"correct_distance_m", ways_m},
          {"error_m", errors_m},
          {"reliability", reliability}};
}

}  // namespace

std::string hard_summary(const std::vector<HardRecord>& records, const HardHead& head) {
  Json curves = Json::array();
  for (const HardRow& row : hard_rows(records))
    if (row.world == "*" && row.disturbance == "*") curves.push_back(curves_json(row));
  return Json{{"results", Json::parse(hard_json(records, head))},
              {"cost", Json::parse(hard_cost_json(records, head))},
              {"curves", std::move(curves)}}
      .dump();
}

}  // namespace mstsl::report
