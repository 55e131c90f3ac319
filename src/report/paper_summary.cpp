#include <algorithm>

#include <nlohmann/json.hpp>

#include "mstsl/eval/protocol_report.hpp"
#include "mstsl/report/page.hpp"

namespace mstsl::report {
namespace {

using Json = nlohmann::ordered_json;

/// What protocol_json() sums up, one by one: the ways to the first right pose and the errors of first poses.
Json curves_json(const ProtocolResult& result, FieldModel model) {
  std::vector<double> cld_m, error_m;
  std::size_t runs = 0;
  for (const ProtocolRun& run : result.runs) {
    if (run.model != model) continue;
    ++runs;
    if (run.evaluation.correct_distance_m) cld_m.push_back(*run.evaluation.correct_distance_m);
    if (const JudgedAnswer* first = run.evaluation.first()) error_m.push_back(first->error.position_m);
  }
  std::ranges::sort(cld_m);
  std::ranges::sort(error_m);
  return {{"model", to_string(model)}, {"runs", runs}, {"cld_m", cld_m}, {"first_error_m", error_m}};
}

}  // namespace

std::string paper_summary(const ProtocolResult& result) {
  Json curves = Json::array();
  for (const FieldModel model : result.models) curves.push_back(curves_json(result, model));
  return Json{{"results", Json::parse(protocol_json(result))}, {"curves", std::move(curves)}}.dump();
}

}  // namespace mstsl::report
