#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/core/random.hpp"
#include "mstsl/datasets/aalto_robot.hpp"
#include "mstsl/datasets/carmen.hpp"
#include "mstsl/datasets/cea_corridor.hpp"
#include "mstsl/datasets/dataset_writer.hpp"
#include "mstsl/datasets/kaist.hpp"

#include "interrupt.hpp"
#include "progress.hpp"
#include "session.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

/// What the user gave; nothing where the data set's own default holds.
struct ConvertWish {
  std::string dataset;
  fs::path input;
  fs::path output;
  std::optional<std::size_t> runs;
  std::optional<double> run_length_m;
  std::optional<double> bias_uT;
  std::optional<double> noise_uT;
  std::optional<double> mapped_share;
  bool no_lanes = false;
};

template <typename T>
void apply(const std::optional<T>& wished, T& option) {
  if (wished) option = *wished;
}

template <typename Options>
Options options_of(const ConvertWish& wish) {
  Options options;
  apply(wish.runs, options.runs.count);
  apply(wish.run_length_m, options.runs.length_m);
  apply(wish.bias_uT, options.robot.magnetometer.bias_sigma_uT);
  apply(wish.noise_uT, options.robot.magnetometer.noise_uT);
  return options;
}

Result<datasets::Dataset> make_dataset(const ConvertWish& wish, const Random& random) {
  if (wish.dataset == "aalto-robot") return datasets::aalto_robot(wish.input);
  if (wish.dataset == "cea-corridor")
    return datasets::cea_corridor(wish.input, options_of<datasets::CeaCorridorOptions>(wish), random);
  if (wish.dataset == "kaist-n1-7f")
    return datasets::kaist_n1_7f(wish.input, options_of<datasets::KaistOptions>(wish), random);
  auto options = options_of<datasets::CarmenOptions>(wish);
  apply(wish.mapped_share, options.mapped_share);
  options.drive_lanes = !wish.no_lanes;
  return datasets::carmen(wish.input, options, random);
}

void report(const Session& session, const ConvertWish& wish, const datasets::Dataset& dataset) {
  if (session.json) {
    const nlohmann::ordered_json summary = {
        {"folder", wish.output.string()},    {"map", (wish.output / "map.yaml").string()},
        {"surveys", dataset.surveys.size()}, {"runs", dataset.runs.size()},
        {"checks", dataset.checks.size()},   {"provenance", dataset.provenance}};
    fmt::print("{}\n", summary.dump());
  } else if (!session.quiet) {
    fmt::print("{}\n{}: map.yaml, {} surveys, {} runs with their truth, {} checks, README.txt\n",
               dataset.provenance, wish.output.string(), dataset.surveys.size(), dataset.runs.size(),
               dataset.checks.size());
  }
}

Result<Exit> convert(const Session& session, const ConvertWish& wish) {
  const Result<datasets::Dataset> dataset = make_dataset(wish, Random(session.seed));
  if (!dataset) return dataset.error();
  Progress progress("writing logs", session.quiet);
  const auto show = [&](double share) { return progress.show(share), !interrupted(); };
  if (const Result<void> written = datasets::write_dataset(*dataset, wish.output, show); !written)
    return written.error();
  report(session, wish, *dataset);
  return Exit::kDone;
}

}  // namespace

void add_convert(CLI::App& app, Session& session) {
  auto wish = std::make_shared<ConvertWish>();
  CLI::App* command = app.add_subcommand("convert", "Make maps, surveys and runs from public recordings");
  command->add_option("--dataset", wish->dataset, "Which recordings these are")
      ->required()
      ->check(CLI::IsMember({"aalto-robot", "cea-corridor", "kaist-n1-7f", "carmen"}));
  command->add_option("input", wish->input, "Folder of the recordings; for carmen the *-corrected.log(.gz)")
      ->required()
      ->check(CLI::ExistingPath);
  command
      ->add_option("-o,--output", wish->output,
                   "Folder for map.yaml, survey_*, run_*, truth_*, check_*, README.txt")
      ->required();
  command->add_option("--runs", wish->runs, "How many runs to cut out")->check(CLI::Range(1, 10000));
  command->add_option("--run-length", wish->run_length_m, "Length of a run in m")
      ->check(CLI::Range(1.0, 1000.0));
  command->add_option("--bias", wish->bias_uT, "SD of a constant magnetometer error per run and axis, uT")
      ->check(CLI::Range(0.0, 1000.0));
  command->add_option("--noise", wish->noise_uT, "SD of white noise added to the magnetometer, uT")
      ->check(CLI::Range(0.0, 1000.0));
  command
      ->add_option("--mapped-share", wish->mapped_share, "carmen: share of the way that makes map and survey")
      ->check(CLI::Range(0.05, 0.95));
  command->add_flag("--no-lanes", wish->no_lanes,
                    "carmen: survey along the recorded way only, not along every lane");
  add_common_options(*command, session);
  command->callback([wish, &session] {
    if (wish->dataset == "aalto-robot" &&
        (wish->runs || wish->run_length_m || wish->bias_uT || wish->noise_uT))
      throw CLI::ValidationError(
          "aalto-robot has no runs: --runs, --run-length, --bias and --noise mean nothing");
    if (wish->dataset != "carmen" && (wish->mapped_share || wish->no_lanes))
      throw CLI::ValidationError("--mapped-share and --no-lanes are for --dataset carmen only");
    session.work = [wish, &session] { return convert(session, *wish); };
  });
}

}  // namespace mstsl::app
