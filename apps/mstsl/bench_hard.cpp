#include "bench_hard.hpp"

#include <optional>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <sys/resource.h>

#include "mstsl/eval/hard_protocol.hpp"
#include "mstsl/eval/hard_report.hpp"
#include "mstsl/eval/hard_trace.hpp"
#include "mstsl/io/atomic_file.hpp"
#include "mstsl/report/page.hpp"
#include "mstsl/sim/world.hpp"

#include "build_hash.hpp"
#include "hard_drawings.hpp"
#include "interrupt.hpp"
#include "progress.hpp"

namespace mstsl::app {
namespace {

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

HardProtocolOptions options_of(const Session& session, const HardWish& wish, int runs,
                               const std::filesystem::path& folder) {
  HardProtocolOptions options;
  options.methods = wish.methods;
  if (!wish.worlds.empty()) options.worlds = wish.worlds;
  options.disturbances = wish.cases;
  if (wish.cases == std::vector<std::string>{"each"}) options.disturbances = disturbance_names();
  options.set = wish.set == "kidnap" ? CaseSet::kKidnap : wish.set == "long" ? CaseSet::kLong : CaseSet::kFix;
  options.runs = runs;
  options.buildings = wish.buildings;
  options.length_m = wish.length_m;
  options.scan_rate_hz = wish.scan_rate_hz;
  options.beams = wish.beams;
  options.seed = session.seed;
  options.threads = session.threads;
  options.crew = session.crew;
  options.folder = folder;
  options.build = build_hash();
  return options;
}

/// The page that shows it all, with the runs worth looking at driven once more.
Result<std::string> page_of(const HardProtocolOptions& options, const HardWish& wish,
                            const std::vector<HardRecord>& records, const HardHead& head) {
  auto runs = trace_hard_runs(options, worth_looking_at(records, options.methods, wish.replays));
  if (!runs) return runs.error();
  report::Page page;
  page.title = fmt::format("Hard protocol, {}: {} runs, {} method{}", wish.set,
                           records.size() / options.methods.size(), options.methods.size(),
                           options.methods.size() == 1 ? "" : "s");
  page.subtitle = fmt::format("{}, commit {}", records.empty() ? "" : records.front().options, head.commit);
  page.summary_json = report::hard_summary(records, head);
  page.runs = std::move(runs).value();
  return report::html(page);
}

}  // namespace

void add_hard_options(CLI::App& command, HardWish& wish) {
  const std::string group = "Protocol hard";
  command.add_option("--method", wish.methods, "Methods, each on the same events")
      ->delimiter(',')
      ->check(CLI::IsMember(method_names()))
      ->capture_default_str()
      ->group(group);
  command.add_option("--worlds", wish.worlds, "Buildings (default: the five of the protocol)")
      ->delimiter(',')
      ->check(CLI::IsMember(sim::world_names()))
      ->group(group);
  std::vector<std::string> cases = disturbance_names();
  cases.emplace_back("each");
  command.add_option("--cases", wish.cases, "Disturbances; each: all of these, one by one")
      ->delimiter(',')
      ->check(CLI::IsMember(cases))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--set", wish.set,
                  "fix: switched on somewhere; kidnap: and carried away; long: see --length")
      ->check(CLI::IsMember({"fix", "kidnap", "long"}))
      ->capture_default_str()
      ->group(group);
  command.add_option("--buildings", wish.buildings, "Buildings of each world, with other steel")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->group(group);
  command.add_option("--length", wish.length_m, "Metres driven in a run")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str()
      ->group(group);
  command.add_option("--scan-rate", wish.scan_rate_hz, "Scans a second")
      ->check(CLI::Range(0.5, 100.0))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--replays", wish.replays,
                  "Runs to be looked at in the report: one a world, and what failed")
      ->check(CLI::Range(0, 200))
      ->capture_default_str()
      ->group(group);
  command.add_option("--beams", wish.beams, "Beams of a scan")
      ->check(CLI::Range(2, 100000))
      ->capture_default_str()
      ->group(group);
}

Result<Exit> bench_hard(const Session& session, const HardWish& wish, int runs,
                        const std::filesystem::path& folder) {
  HardProtocolOptions options = options_of(session, wish, runs, folder);
  std::optional<Progress> bar;
  bar.emplace("hard protocol", session.quiet);
  options.progress = [&](const char*, double share) {
    bar->show(share);
    return !interrupted();
  };
  const auto records = run_hard_protocol(options);
  if (!records) return records.error();
  if (!session.crew.leads()) return Exit::kDone;
  const HardHead head{MSTSL_COMMIT, options.build, options.seed, peak_memory_mb()};
  bar.emplace("replays", session.quiet);
  const auto page = page_of(options, wish, *records, head);
  if (!page) return page.error();
  bar.reset();
  const std::string text = hard_text(*records), json = hard_json(*records, head);
  for (const auto& [name, content] : {std::pair{fmt::format("table_{}.txt", wish.set), text},
                                      {fmt::format("table_{}.csv", wish.set), hard_csv(*records)},
                                      {fmt::format("results_{}.json", wish.set), json},
                                      {fmt::format("cost_{}.json", wish.set), hard_cost_json(*records, head)},
                                      {fmt::format("report_{}.html", wish.set), *page}})
    if (const Result<void> written = io::write_file(folder / name, content); !written) return written.error();
  if (const Result<void> drawn = draw_hard_figures(*records, wish.set, folder); !drawn) return drawn.error();
  if (session.json)
    fmt::print("{}", json);
  else if (!session.quiet)
    fmt::print(
        "{0}\n{1}: report_{2}.html, hard_{2}_*.svg, table_{2}.txt and .csv, results_{2}.json, cost_{2}.json, "
        "runs.jsonl\n",
        text, folder.string(), wish.set);
  return Exit::kDone;
}

}  // namespace mstsl::app
