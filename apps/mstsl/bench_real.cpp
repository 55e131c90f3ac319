#include "bench_real.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/datasets/carmen.hpp"
#include "mstsl/datasets/cea_corridor.hpp"
#include "mstsl/datasets/kaist.hpp"
#include "mstsl/eval/recorded_protocol.hpp"
#include "mstsl/eval/summary_report.hpp"
#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/file_bytes.hpp"
#include "mstsl/report/page.hpp"

#include "interrupt.hpp"
#include "progress.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A recording, what of it is real, and how runs are cut from it.
struct Recording {
  const char *name, *real, *dataset, *path;
  std::size_t runs;
  double mapped_share;  ///< carmen: the first part of the way, which makes map and survey
};

constexpr const char *kField = "field; lidar and odometry simulated",
                     *kPlan = "floor plan and field; lidar and odometry simulated",
                     *kRobot = "lidar and odometry; field simulated over the real map";

/// ACES comes back so late that only its last fifth revisits the rest.
constexpr Recording kRecordings[] = {
    {"cea-corridor", kField, "cea-corridor", "cea-corridor", 50, 0.0},
    {"kaist-n1-7f", kPlan, "kaist-n1-7f", "kaist-n1-7f", 20, 0.0},
    {"aces", kRobot, "carmen", "carmen/aces-corrected.log.gz", 15, 0.8},
    {"intel", kRobot, "carmen", "carmen/intel-corrected.log.gz", 50, 0.6},
    {"freiburg-079", kRobot, "carmen", "carmen/freiburg-079-corrected.log.gz", 50, 0.6},
    {"seattle", kRobot, "carmen", "carmen/seattle-corrected.log.gz", 50, 0.5}};

Result<datasets::Dataset> load(const Recording& recording, const fs::path& path, std::size_t runs,
                               const Random& random) {
  if (recording.dataset == std::string("cea-corridor")) {
    datasets::CeaCorridorOptions options;
    options.runs.count = runs;
    return datasets::cea_corridor(path, options, random);
  }
  if (recording.dataset == std::string("kaist-n1-7f")) {
    datasets::KaistOptions options;
    options.runs.count = runs;
    return datasets::kaist_n1_7f(path, options, random);
  }
  datasets::CarmenOptions options;
  options.runs.count = runs;
  options.mapped_share = recording.mapped_share;
  return datasets::carmen(path, options, random);
}

RecordedCase case_of(const std::string& name, datasets::Dataset dataset) {
  RecordedCase recorded{name, std::move(dataset.map), {}, {}};
  for (auto& log : dataset.surveys) recorded.surveys.push_back({log.rig, std::move(log.play)});
  for (auto& log : dataset.runs) recorded.runs.push_back({log.rig, std::move(log.play)});
  return recorded;
}

/// What is known of a data set that was finished, if it was made by the same command.
std::optional<Json> finished(const fs::path& file, const Json& made_by) {
  const Result<std::string> text = io::read_file(file, std::size_t{1} << 30);
  if (!text) return std::nullopt;
  const Json json = Json::parse(*text, nullptr, false);
  if (json.is_discarded() || !json.contains("made_by") || json["made_by"] != made_by) return std::nullopt;
  return json["results"];
}

std::string percent(const Json& rate) { return fmt::format("{:.1f} %", 100 * rate["share"].get<double>()); }

std::string text_of(const Json& results) {
  std::string text = fmt::format("{:<14} {:<12} {:>5} {:>9} {:>9} {:>14} {:>11}  {}\n", "data set", "method",
                                 "runs", "success", "at end", "wrong at .999", "CLD median", "real");
  for (const Json& result : results) {
    const Json &of = result["evaluation"], &cld = of["correct_distance_m"]["median"];
    text += fmt::format(
        "{:<14} {:<12} {:>5} {:>9} {:>9} {:>14} {:>11}  {}\n", result["dataset"].get<std::string>(),
        result["method"].get<std::string>(), of["runs"].get<int>(), percent(of["success"]),
        percent(of["final_success"]), of["runs_wrong_at_0.999"]["hits"].get<int>(),
        cld.is_null() ? "-" : fmt::format("{:.2f} m", cld.get<double>()), result["real"].get<std::string>());
  }
  return text;
}

struct Finished {
  Json results = Json::object();  ///< by recording
  std::vector<RunTrace> traces;
};

/// Runs one data set, or takes what an earlier call left.
Result<void> run(const Session& session, const RealWish& wish, const std::vector<std::string>& methods,
                 const Recording& recording, const fs::path& folder, Finished& all) {
  const std::size_t runs = wish.runs ? static_cast<std::size_t>(*wish.runs) : recording.runs;
  const Json made_by{{"commit", MSTSL_COMMIT}, {"seed", session.seed}, {"runs", runs}, {"methods", methods}};
  const fs::path kept = folder / fmt::format("{}.json", recording.name);
  if (auto known = finished(kept, made_by)) {
    all.results[recording.name] = *std::move(known);
    return {};
  }
  Progress progress(recording.name, session.quiet);
  Result<datasets::Dataset> dataset = load(recording, wish.data / recording.path, runs, Random(session.seed));
  if (!dataset) return dataset.error();
  RecordedOptions options;
  options.methods = methods;
  options.method.two_step.seed = session.seed;
  options.method.threads = options.threads = session.threads;
  options.progress = [&](double share) { return progress.show(share), !interrupted(); };
  Result<RecordedOutcome> outcome = run_recorded_case(case_of(recording.name, *std::move(dataset)), options);
  if (!outcome) return outcome.error();
  Json results = Json::array();
  for (const RecordedResult& result : outcome->results)
    results.push_back({{"dataset", recording.name},
                       {"real", recording.real},
                       {"method", result.method},
                       {"seed", session.seed},
                       {"evaluation", Json::parse(to_json(summarise(result.runs)))}});
  if (auto written = io::write_file(kept, Json{{"made_by", made_by}, {"results", results}}.dump(1) + "\n");
      !written)
    return written;
  all.results[recording.name] = std::move(results);
  all.traces.push_back(std::move(outcome->trace));
  return {};
}

/// The recordings that are there and this process's turn.
Result<Finished> run_all(const Session& session, const RealWish& wish,
                         const std::vector<std::string>& methods, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error(fmt::format("{}: cannot make the folder: {}", folder.string(), error.message()));
  Finished all;
  int turn = 0;
  for (const Recording& recording : kRecordings) {
    if (turn++ % session.crew.size != session.crew.rank) continue;
    if (!fs::exists(wish.data / recording.path)) {
      if (!session.quiet)
        fmt::print(stderr, "mstsl: {} is skipped: there is no {}\n", recording.name,
                   (wish.data / recording.path).string());
      continue;
    }
    if (auto done = run(session, wish, methods, recording, folder, all); !done) return done.error();
  }
  return all;
}

/// The results of all processes, in the order of the recordings.
Result<Json> results_of_all(const Crew& crew, const Result<Finished>& mine) {
  const auto told = pooled(crew, mine ? Result<std::string>(mine->results.dump()) : mine.error());
  if (!told) return told.error();
  Json by_name = Json::object(), results = Json::array();
  for (const std::string& one : *told) by_name.update(Json::parse(one));
  for (const Recording& recording : kRecordings)
    if (by_name.contains(recording.name))
      for (Json& result : by_name[recording.name]) results.push_back(std::move(result));
  return results;
}

Result<void> write(const Json& results, const std::vector<RunTrace>& traces, const fs::path& folder,
                   const std::string& text) {
  report::Page page;
  page.title = "Real recordings";
  page.subtitle = "The first run of each data set that this call drove; the table is in real.txt";
  page.runs = traces;
  for (const auto& [name, content] : {std::pair{"real.json", results.dump(1) + "\n"},
                                      {"real.txt", text},
                                      {"report_real.html", report::html(page)}})
    if (auto written = io::write_file(folder / name, content); !written) return written;
  return {};
}

}  // namespace

void add_real_options(CLI::App& command, RealWish& wish) {
  const std::string group = "Protocol real";
  command
      .add_option("--data", wish.data,
                  "Folder with the recordings: cea-corridor/, kaist-n1-7f/, carmen/*-corrected.log.gz")
      ->check(CLI::ExistingDirectory)
      ->group(group);
  command.add_option("--real-runs", wish.runs, "Runs of each data set (default: 15 to 50, as it allows)")
      ->check(CLI::Range(1, 10000))
      ->group(group);
}

Result<Exit> bench_real(const Session& session, const RealWish& wish, const std::vector<std::string>& methods,
                        const fs::path& folder) {
  if (wish.data.empty()) return Error("--protocol real needs --data FOLDER: where the recordings are");
  Result<Finished> mine = run_all(session, wish, methods, folder);
  const Result<Json> results = results_of_all(session.crew, mine);
  if (!results) return results.error();
  if (!session.crew.leads()) return Exit::kDone;
  if (results->empty()) return Error(wish.data.string() + ": none of the recordings is there");
  const std::string text = text_of(*results);
  if (auto written = write(*results, mine->traces, folder, text); !written) return written.error();
  if (session.json)
    fmt::print("{}\n", results->dump());
  else if (!session.quiet)
    fmt::print("{}{}: real.txt, real.json, report_real.html\n", text, folder.string());
  return Exit::kDone;
}

}  // namespace mstsl::app
