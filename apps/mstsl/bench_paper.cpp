#include "bench_paper.hpp"

#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "mstsl/eval/protocol_report.hpp"
#include "mstsl/io/atomic_file.hpp"
#include "mstsl/report/page.hpp"

#include "build_hash.hpp"
#include "interrupt.hpp"
#include "paper_drawings.hpp"
#include "progress.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

PaperProtocolOptions options_of(const Session& session, const PaperWish& wish, int runs,
                                const std::string& world, const fs::path& folder) {
  PaperProtocolOptions options;
  options.world = world;
  options.seed = session.seed;
  options.threads = session.threads;
  options.crew = session.crew;
  options.folder = folder;
  options.build = build_hash();
  options.waypoints = wish.waypoints;
  options.runs_per_waypoint = runs;
  options.survey.survey.fingerprints = wish.fingerprints.value_or(paper_fingerprints(world).value_or(0));
  options.survey.survey.lane_spacing_m = wish.lane_spacing_m;
  options.robot.magnetometer.bias_sigma_uT = wish.bias_uT;
  options.moved_fraction = wish.moved;
  options.hypotheses = wish.hypotheses;
  options.models.clear();
  for (const std::string& name : wish.models) options.models.push_back(*field_model_from(name));
  return options;
}

std::string page_of(const ProtocolResult& result) {
  report::Page page;
  page.title = fmt::format("The paper's experiment: {}", result.world);
  page.subtitle = fmt::format("mstsl {}, {} runs, seed {}", MSTSL_VERSION,
                              result.runs.size() / result.models.size(), result.seed);
  page.paper_json = report::paper_summary(result);
  page.runs = result.traces;
  return report::html(page);
}

Result<void> write_report(const ProtocolResult& result, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error(fmt::format("{}: cannot make the folder: {}", folder.string(), error.message()));
  const std::string name = fmt::format("paper_{}", result.world);
  for (const auto& [ending, text] : {std::pair{".txt", protocol_text(result)},
                                     {".json", protocol_json(result)},
                                     {"_runs.csv", protocol_runs_csv(result)},
                                     {"_cdf.csv", protocol_cdf_csv(result)},
                                     {".html", page_of(result)}})
    if (const Result<void> written = io::write_file(folder / (name + ending), text); !written) return written;
  return draw_paper_figures(result, folder);
}

}  // namespace

void add_paper_options(CLI::App& command, PaperWish& wish) {
  const std::string group = "Protocol paper";
  command.add_option("--world", wish.world, "Where")
      ->check(CLI::IsMember({"corridor", "carpark", "both"}))
      ->capture_default_str()
      ->group(group);
  command.add_option("--models", wish.models, "Field models to compare")
      ->check(CLI::IsMember({"gpr", "bilinear", "fingerprint"}))
      ->delimiter(',')
      ->capture_default_str()
      ->group(group);
  command.add_option("--waypoints", wish.waypoints, "Starts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--fingerprints", wish.fingerprints,
                  "Survey so many; 0: one pass over every lane (default: the paper's 67238 and 118688)")
      ->check(CLI::Range(0, 10'000'000))
      ->group(group);
  command.add_option("--lane-spacing", wish.lane_spacing_m, "Between the survey's parallel lines, m")
      ->check(CLI::Range(0.05, 20.0))
      ->capture_default_str()
      ->group(group);
  command.add_option("--bias", wish.bias_uT, "SD of the magnetometer's constant error per run and axis, uT")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--moved", wish.moved,
                  "Share of the things standing about that move between survey and runs")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("-k,--hypotheses", wish.hypotheses,
                  "Initial hypotheses kept (default: 5 in the corridor, 8 in the car park)")
      ->check(CLI::Range(1, 1000))
      ->group(group);
}

Result<Exit> bench_paper(const Session& session, const PaperWish& wish, int runs, const fs::path& folder) {
  const std::vector<std::string> worlds = wish.world == "both"
                                              ? std::vector<std::string>{"corridor", "carpark"}
                                              : std::vector<std::string>{wish.world};
  for (const std::string& world : worlds) {
    PaperProtocolOptions options = options_of(session, wish, runs, world, folder);
    std::optional<Progress> bar;
    const char* doing = nullptr;
    options.progress = [&](const char* what, double share) {
      if (what != doing) bar.emplace(fmt::format("{}: {}", world, doing = what), session.quiet);
      bar->show(share);
      return !interrupted();
    };
    const Result<ProtocolResult> result = run_paper_protocol(options);
    if (!result) return result.error();
    bar.reset();
    if (!session.crew.leads()) continue;
    if (const Result<void> written = write_report(*result, folder); !written) return written.error();
    if (session.json)
      fmt::print("{}", protocol_json(*result));
    else if (!session.quiet)
      fmt::print("{}\n", protocol_text(*result));
  }
  if (!session.quiet && !session.json)
    fmt::print("{}: paper_{}.html, tables, runs, curves and figures\n", folder.string(),
               worlds.size() == 1 ? worlds.front() : "*");
  return Exit::kDone;
}

}  // namespace mstsl::app
