#include "mstsl/eval/recorded_protocol.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "mstsl/eval/run_loop.hpp"
#include "mstsl/magnetic/fingerprint_collector.hpp"

namespace mstsl {
namespace {

std::vector<Fingerprint> fingerprints_of(const std::vector<RecordedLog>& surveys) {
  std::optional<FingerprintCollector> collector;
  for (const RecordedLog& survey : surveys) {
    if (collector)
      collector->start_session(survey.rig);
    else
      collector.emplace(survey.rig);
    survey.play({[&](const SensorEvent& event) {
                   if (const auto* field = std::get_if<FieldReading>(&event)) collector->observe(*field);
                 },
                 [&](const PoseReading& truth) { collector->observe(truth); }});
  }
  return collector ? collector->finish() : std::vector<Fingerprint>();
}

/// What a case's runs share.
struct Setting {
  std::shared_ptr<const TracedPlace> place;
  std::vector<LocalizerFactory> methods;
};

std::optional<Error> refusal(const RecordedCase& recorded, const RecordedOptions& options) {
  if (recorded.surveys.empty() || recorded.runs.empty() || options.methods.empty())
    return Error(recorded.name + " has no survey, no run, or no method to be tried");
  for (const std::string& method : options.methods)
    if (std::ranges::count(method_names(), method) == 0) return Error("there is no method '" + method + "'");
  return std::nullopt;
}

Result<Setting> prepare(const RecordedCase& recorded, const RecordedOptions& options) {
  FieldMapOptions build = options.field;
  build.threads = options.threads;
  Result<FieldMap> field = build_field_map(fingerprints_of(recorded.surveys), &recorded.map, build);
  if (!field) return field.error();
  Setting setting;
  setting.place = std::make_shared<const TracedPlace>(TracedPlace{recorded.name, recorded.map, *field});
  const auto maps =
      make_localization_maps(recorded.map, std::move(field).value(), {.threads = options.threads});
  if (!maps) return maps.error();
  for (const std::string& name : options.methods) {
    auto method = make_method(name, *maps, options.method);
    if (!method) return method.error();
    setting.methods.push_back(std::move(method).value());
  }
  return setting;
}

struct Played {
  std::vector<RunEvaluation> evaluations;  ///< by method
  std::optional<RunTrace> trace;
};

Played play(const RecordedLog& run, const Setting& setting, const RecordedOptions& options, bool traced) {
  std::vector<std::vector<Estimate>> estimates(setting.methods.size());
  std::vector<RunLoop> loops;
  for (std::size_t m = 0; m < setting.methods.size(); ++m)
    loops.emplace_back(setting.methods[m](run.rig),
                       [&estimates, m](const Estimate& estimate) { estimates[m].push_back(estimate); });
  Trajectory truth;
  ScanRecorder recorder(run.rig);
  run.play({[&](const SensorEvent& event) {
              if (traced) recorder.observe(event);
              for (RunLoop& loop : loops) loop.observe(event);
            },
            [&](const PoseReading& pose) { truth.add(pose.stamp, pose.map_T_base); }});
  Played played;
  for (const auto& of_method : estimates) played.evaluations.push_back(evaluate_run(of_method, truth));
  if (!traced) return played;
  played.trace =
      RunTrace{setting.place->name + ", run 0", setting.place, std::move(truth), recorder.take(), {}};
  for (std::size_t m = 0; m < setting.methods.size(); ++m)
    played.trace->methods.push_back({options.methods[m], std::move(estimates[m])});
  return played;
}

}  // namespace

Result<RecordedOutcome> run_recorded_case(const RecordedCase& recorded, const RecordedOptions& options) {
  if (auto error = refusal(recorded, options)) return *std::move(error);
  const Result<Setting> setting = prepare(recorded, options);
  if (!setting) return setting.error().within(recorded.name);
  std::vector<Played> played(recorded.runs.size());
  std::mutex lock;
  std::size_t done = 0;
  std::atomic<bool> ended = false;
  parallel_for(played.size(), options.threads, [&](std::size_t i) {
    if (ended) return;
    played[i] = play(recorded.runs[i], *setting, options, i == 0);
    const std::scoped_lock guard(lock);
    const double share = static_cast<double>(++done) / static_cast<double>(played.size());
    if (options.progress && !options.progress(share)) ended = true;
  });
  if (ended) return Error("interrupted; the same command goes on from the last data set that was finished");
  RecordedOutcome outcome;
  outcome.trace = *std::move(played.front().trace);
  for (std::size_t m = 0; m < options.methods.size(); ++m) {
    RecordedResult& result = outcome.results.emplace_back(RecordedResult{options.methods[m], {}});
    for (Played& run : played) result.runs.push_back(std::move(run.evaluations[m]));
  }
  return outcome;
}

}  // namespace mstsl
