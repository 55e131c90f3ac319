#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/eval/mapping_protocol.hpp"
#include "mstsl/eval/statistics.hpp"

#include "mapping_record.hpp"

namespace mstsl {
namespace {

/// All runs of one world, mapped one way.
struct Row {
  std::size_t runs = 0, closures = 0, wrong = 0, refuted = 0, runs_with_wrong = 0;
  std::size_t refused_by_field = 0, only_with_field = 0;
  std::vector<double> ate_m, map_error;
  double cpu_s = 0.0, driven_s = 0.0, driven_m = 0.0;
};

/// Robot, world, with the field.
using Key = std::tuple<std::string, std::string, bool>;

/// In the order of the records.
std::vector<std::pair<Key, Row>> rows_of(std::span<const MappingRecord> records) {
  std::vector<std::pair<Key, Row>> rows;
  for (const MappingRecord& r : records) {
    const Key key(r.robot, r.world, r.with_field);
    auto at = std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.first == key; });
    if (at == rows.end()) at = rows.insert(rows.end(), {key, Row{}});
    Row& row = at->second;
    ++row.runs;
    row.closures += r.closures, row.wrong += r.wrong_closures, row.refuted += r.refuted;
    row.runs_with_wrong += r.wrong_closures > 0 ? 1 : 0;
    row.refused_by_field += r.refused_by_field, row.only_with_field += r.closed_only_with_field;
    row.ate_m.push_back(r.ate_rms_m), row.map_error.push_back(r.map_error);
    row.cpu_s += r.cpu_s, row.driven_s += r.driven_s, row.driven_m += r.driven_m;
  }
  return rows;
}

}  // namespace

std::string mapping_text(std::span<const MappingRecord> records) {
  std::string text = fmt::format("{:<6} {:<16} {:<7} {:>4} {:>8} {:>6} {:>11} {:>8} {:>22} {:>9} {:>8}\n",
                                 "robot", "world", "by", "runs", "closures", "wrong", "wrong maps", "refuted",
                                 "ATE m median/95%/max", "map off", "x real");
  for (const auto& [key, row] : rows_of(records))
    text += fmt::format("{:<6} {:<16} {:<7} {:>4} {:>8} {:>6} {:>11} {:>8} {:>22} {:>8.1f}% {:>8.0f}\n",
                        std::get<0>(key), std::get<1>(key), std::get<2>(key) ? "field" : "scans", row.runs,
                        row.closures, row.wrong, row.runs_with_wrong, row.refuted,
                        fmt::format("{:.3f}/{:.3f}/{:.3f}", quantile(row.ate_m, 0.5),
                                    quantile(row.ate_m, 0.95), quantile(row.ate_m, 1.0)),
                        100 * quantile(row.map_error, 0.5), row.driven_s / row.cpu_s);
  return text;
}

std::string mapping_json(std::span<const MappingRecord> records, const MappingProtocolOptions& options,
                         const std::string& commit) {
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
  for (const MappingRecord& record : records) {
    nlohmann::ordered_json run = json_of(record);
    run.erase("cpu_s"), run.erase("driven_s");  // the same bytes for the same drives
    runs.push_back(run);
  }
  const nlohmann::ordered_json all = {{"protocol", "mapping"},     {"commit", commit},
                                      {"seed", options.seed},      {"length_m", options.length_m},
                                      {"runs_each", options.runs}, {"runs", runs}};
  return all.dump() + "\n";
}

}  // namespace mstsl
