#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "mstsl/eval/paper_protocol.hpp"
#include "mstsl/eval/protocol_report.hpp"
#include "mstsl/io/atomic_file.hpp"

#include "bench_hard.hpp"
#include "bench_mapping.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "session.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

struct Wish {
  std::string protocol = "paper";
  fs::path output;
  std::string world = "both";
  std::vector<std::string> models{"gpr", "bilinear", "fingerprint"};
  int waypoints = PaperProtocolOptions{}.waypoints;
  int runs = PaperProtocolOptions{}.runs_per_waypoint;
  std::size_t fingerprints = 0;
  double lane_spacing_m = sim::SurveyOptions{}.lane_spacing_m;
  double bias_uT = sim::MagnetometerOptions{}.bias_sigma_uT;
  double moved = PaperProtocolOptions{}.moved_fraction;
  std::optional<std::size_t> hypotheses;
  HardWish hard;
  MappingWish mapping;
};

PaperProtocolOptions options_of(const Session& session, const Wish& wish, const std::string& world) {
  PaperProtocolOptions options;
  options.world = world;
  options.seed = session.seed;
  options.threads = session.threads;
  options.waypoints = wish.waypoints;
  options.runs_per_waypoint = wish.runs;
  options.survey.survey.fingerprints = wish.fingerprints;
  options.survey.survey.lane_spacing_m = wish.lane_spacing_m;
  options.robot.magnetometer.bias_sigma_uT = wish.bias_uT;
  options.moved_fraction = wish.moved;
  options.hypotheses = wish.hypotheses;
  options.models.clear();
  for (const std::string& name : wish.models) options.models.push_back(*field_model_from(name));
  return options;
}

Result<void> write_report(const ProtocolResult& result, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error(fmt::format("{}: cannot make the folder: {}", folder.string(), error.message()));
  const std::string name = fmt::format("paper_{}", result.world);
  for (const auto& [ending, text] : {std::pair{".txt", protocol_text(result)},
                                     {".json", protocol_json(result)},
                                     {"_runs.csv", protocol_runs_csv(result)},
                                     {"_cdf.csv", protocol_cdf_csv(result)}})
    if (const Result<void> written = io::write_file(folder / (name + ending), text); !written) return written;
  return {};
}

Result<Exit> bench(const Session& session, const Wish& wish) {
  if (wish.protocol == "hard") return bench_hard(session, wish.hard, wish.runs, wish.output);
  if (wish.protocol == "mapping")
    return bench_mapping(session, wish.mapping, wish.hard.worlds, wish.runs, wish.output);
  const std::vector<std::string> worlds = wish.world == "both"
                                              ? std::vector<std::string>{"corridor", "carpark"}
                                              : std::vector<std::string>{wish.world};
  for (const std::string& world : worlds) {
    PaperProtocolOptions options = options_of(session, wish, world);
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
    if (const Result<void> written = write_report(*result, wish.output); !written) return written.error();
    if (session.json)
      fmt::print("{}", protocol_json(*result));
    else if (!session.quiet)
      fmt::print("{}\n", protocol_text(*result));
  }
  if (!session.quiet && !session.json) fmt::print("tables, runs and curves: {}\n", wish.output.string());
  return Exit::kDone;
}

}  // namespace

void add_bench(CLI::App& app, Session& session) {
  auto wish = std::make_shared<Wish>();
  CLI::App* command = app.add_subcommand("bench", "Measure the methods by a fixed protocol");
  command
      ->add_option(
          "--protocol", wish->protocol,
          "paper: ten starts driven ten times each, as in the paper; hard: symmetric buildings and "
          "whatever disturbs a robot; mapping: maps made from drives, by scans alone and with the field")
      ->check(CLI::IsMember({"paper", "hard", "mapping"}))
      ->capture_default_str();
  command->add_option("-o,--output", wish->output, "Folder for tables, runs and curves")->required();
  command->add_option("--world", wish->world, "Where")
      ->check(CLI::IsMember({"corridor", "carpark", "both"}))
      ->capture_default_str();
  command->add_option("--models", wish->models, "Field models to compare")
      ->check(CLI::IsMember({"gpr", "bilinear", "fingerprint"}))
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--waypoints", wish->waypoints, "Starts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--runs", wish->runs, "Runs from each start; hard: of each building and case")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      ->add_option("--fingerprints", wish->fingerprints,
                   "Survey so many (paper: 67238 and 118688); 0: one pass over every lane")
      ->check(CLI::Range(0, 10'000'000))
      ->capture_default_str();
  command->add_option("--lane-spacing", wish->lane_spacing_m, "Between the survey's parallel lines, m")
      ->check(CLI::Range(0.05, 20.0))
      ->capture_default_str();
  command->add_option("--bias", wish->bias_uT, "SD of the magnetometer's constant error per run and axis, uT")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command
      ->add_option("--moved", wish->moved,
                   "Share of the things standing about that move between survey and runs")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("-k,--hypotheses", wish->hypotheses,
                   "Initial hypotheses kept (default: 5 in the corridor, 8 in the car park)")
      ->check(CLI::Range(1, 1000));
  add_hard_options(*command, wish->hard);
  add_mapping_options(*command, wish->mapping);
  add_common_options(*command, session);
  command->callback([wish, &session] { session.work = [wish, &session] { return bench(session, *wish); }; });
}

}  // namespace mstsl::app
