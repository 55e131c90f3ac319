#include "mstsl/eval/paper_protocol.hpp"

#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "eval/paper_figures.hpp"
#include "judged_json.hpp"
#include "paper_setting.hpp"
#include "paper_start.hpp"
#include "piece_store.hpp"
#include "piecework.hpp"

namespace mstsl {
namespace {

using Json = nlohmann::ordered_json;

std::string piece_name(const PaperProtocolOptions& options, std::size_t start) {
  return fmt::format("paper {} start {}", options.world, start);
}

/// What decides the runs and can be chosen.
std::string text_of(const PaperProtocolOptions& o, std::size_t hypotheses) {
  std::string text = fmt::format(
      "seed {} starts {} x {} fingerprints {} lanes {} bias_uT {} moved {} k {} models", o.seed, o.waypoints,
      o.runs_per_waypoint, o.survey.survey.fingerprints, o.survey.survey.lane_spacing_m,
      o.robot.magnetometer.bias_sigma_uT, o.moved_fraction, hypotheses);
  for (const FieldModel model : o.models) text += fmt::format(" {}", to_string(model));
  return text;
}

std::string line_of(const std::vector<ProtocolRun>& runs) {
  Json list = Json::array();
  for (const ProtocolRun& run : runs)
    list.push_back({run.waypoint, run.run, run.alignment_error_rad, json_of(run.evaluation)});
  return list.dump();
}

Result<std::vector<ProtocolRun>> runs_from(const std::string* line, const std::vector<FieldModel>& models) {
  if (line == nullptr) return Error("a start is missing");
  try {
    std::vector<ProtocolRun> runs;
    const Json list = Json::parse(*line);
    for (std::size_t m = 0; m < models.size(); ++m) {
      const Json& run = list.at(m);
      runs.push_back({run.at(0), run.at(1), models[m], run.at(2), evaluation_from(run.at(3))});
    }
    return runs;
  } catch (const std::exception& error) {
    return Error(fmt::format("a kept run cannot be read: {}; take another folder", error.what()));
  }
}

/// Makes this process's portion of the starts that the store does not have.
void run_missing(const PaperSetting& setting, const PaperProtocolOptions& options,
                 const TwoStepOptions& two_step, const std::vector<std::size_t>& missing, Piecework& work) {
  const Portion mine = portion_of(missing.size(), options.crew);
  work.expect(mine.last - mine.first);
  parallel_for(mine.last - mine.first, options.threads, [&](std::size_t i) {
    if (work.stopped()) return;
    const std::size_t number = missing[mine.first + i];
    const Result<PaperStart> start = run_start(setting, options, two_step, number, Traced::kNo);
    if (!start) return work.fail(start.error());
    work.finish({{piece_name(options, number), line_of(start->runs)}});
  });
}

/// The first run from each waypoint, driven once more to be looked at.
Result<std::vector<RunTrace>> traces_of(const PaperSetting& setting, const PaperProtocolOptions& options,
                                        const TwoStepOptions& two_step) {
  std::vector<std::optional<Result<PaperStart>>> starts(static_cast<std::size_t>(options.waypoints));
  parallel_for(starts.size(), options.threads, [&](std::size_t waypoint) {
    const std::size_t number = waypoint * static_cast<std::size_t>(options.runs_per_waypoint);
    starts[waypoint] = run_start(setting, options, two_step, number, Traced::kYes);
  });
  std::vector<RunTrace> traces;
  for (auto& start : starts) {
    if (!*start) return start->error();
    traces.push_back(*std::move((*start)->trace));
  }
  return traces;
}

}  // namespace

std::optional<std::size_t> paper_fingerprints(std::string_view world) {
  const auto figures = paper_figures(world);
  if (!figures) return std::nullopt;
  return figures->fingerprints;
}

Result<ProtocolResult> run_paper_protocol(const PaperProtocolOptions& options) {
  TwoStepOptions two_step = options.two_step;
  const std::size_t hypotheses = options.hypotheses.value_or(options.world == "corridor" ? 5 : 8);
  two_step.initialise.distinct.count = hypotheses;
  if (auto error = invalid(two_step)) return *error;
  auto store = PieceStore::open(options.folder, {text_of(options, hypotheses), options.build}, options.crew);
  if (!store) return store.error();
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < static_cast<std::size_t>(options.waypoints * options.runs_per_waypoint); ++i)
    if (!store->find(piece_name(options, i))) missing.push_back(i);

  Piecework work(*store, options.progress);
  const Result<PaperSetting> setting = prepare(options, work);
  if (setting) run_missing(*setting, options, two_step, missing, work);
  const Result<void> mine = setting ? work.end() : setting.error();
  if (const Result<void> all = store->gather(options.crew, mine); !all) return all.error();

  ProtocolResult result{options.world,         options.seed,   hypotheses,
                        setting->fingerprints, options.models, {},
                        setting->waypoints_m,  setting->place, {}};
  for (std::size_t i = 0; i < static_cast<std::size_t>(options.waypoints * options.runs_per_waypoint); ++i) {
    auto runs = runs_from(store->find(piece_name(options, i)), options.models);
    if (!runs) return runs.error();
    std::move(runs->begin(), runs->end(), std::back_inserter(result.runs));
  }
  if (!options.crew.leads()) return result;
  auto traces = traces_of(*setting, options, two_step);
  if (!traces) return traces.error();
  result.traces = std::move(traces).value();
  return result;
}

}  // namespace mstsl
