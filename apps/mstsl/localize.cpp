#include <chrono>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/eval/run_loop.hpp"
#include "mstsl/io/estimates.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/io/recording_info.hpp"
#include "mstsl/io/tum.hpp"
#include "mstsl/localize/methods.hpp"

#include "calibration_option.hpp"
#include "interrupt.hpp"
#include "output_paths.hpp"
#include "progress.hpp"
#include "run_picture.hpp"
#include "run_report.hpp"
#include "session.hpp"
#include "topic_options.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

struct Wish {
  fs::path map;
  fs::path field;
  std::string method = "joint";
  std::size_t hypotheses = DistinctOptions{}.count;
  double localized_from = JointOptions{}.localized_from;
  fs::path output;
  std::optional<fs::path> tum;
  std::optional<fs::path> picture, report, truth;
  std::optional<fs::path> calibration;
  std::vector<fs::path> logs;
  io::PlayOptions play;
};

/// CPU time of this process so far, in s.
double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void warn(const Session& session, const std::string& sentence) {
  if (!session.quiet) fmt::print(stderr, "mstsl: warning: {}\n", sentence);
}

using Maps = std::shared_ptr<const LocalizationMaps>;

Result<Maps> load_maps(const Session& session, const Wish& wish) {
  Result<io::MapFile> map = io::read_map_file(wish.map);
  if (!map) return map.error();
  for (const std::string& warning : map->warnings) warn(session, warning);
  Result<FieldMap> field = io::read_field_map(wish.field);
  if (!field) return field.error();
  Result<Maps> maps =
      make_localization_maps(std::move(map->grid), std::move(field).value(), {.threads = session.threads});
  if (!maps) return maps.error().within(fmt::format("{} with {}", wish.map.string(), wish.field.string()));
  return maps;
}

/// When the logs begin and how long they last, for the progress bar; nothing where they do not say.
std::optional<std::pair<Stamp, double>> extent(const std::vector<fs::path>& logs) {
  const auto first = io::describe_recording(logs.front()), last = io::describe_recording(logs.back());
  if (!first || !last || !first->first || !last->last) return std::nullopt;
  return std::pair{*first->first, std::max(*last->last - *first->first, 1e-3)};
}

/// The estimates as they are written, and what went wrong with that.
struct Output {
  io::EstimatesWriter estimates;
  std::optional<io::TumWriter> tum;
  std::optional<Error> error;

  void write(const Estimate& estimate) {
    if (error) return;
    keep(estimates.write(estimate));
    if (tum && estimate.map_T_base) keep(tum->write({estimate.stamp, *estimate.map_T_base}));
  }
  void close(const io::Summary& summary) {
    keep(estimates.close(summary));
    if (tum) keep(tum->close());
  }
  void keep(const Result<void>& result) {
    if (!result && !error) error = result.error();
  }
};

Result<Output> open_output(const Wish& wish) {
  auto estimates = io::EstimatesWriter::open(wish.output);
  if (!estimates) return estimates.error();
  Output output{std::move(estimates).value(), std::nullopt, std::nullopt};
  if (!wish.tum) return output;
  auto tum = io::TumWriter::open(*wish.tum);
  if (!tum) return tum.error();
  output.tum = std::move(tum).value();
  return output;
}

/// What the run says of itself. Only what follows from the input: the same run gives the same file.
io::Summary summarise(const Wish& wish, const RunCounts& counts, const io::PlayReport& played,
                      const LocalizerReport& report, bool was_interrupted) {
  const auto number = [](std::uint64_t value) { return static_cast<std::int64_t>(value); };
  io::Summary summary{{"method", wish.method},
                      {"status", std::string(to_string(counts.last_status))},
                      {"odometry", number(counts.odometry)},
                      {"scans", number(counts.scans)},
                      {"field_readings", number(counts.field_readings)},
                      {"estimates", number(counts.estimates)},
                      {"interrupted", was_interrupted},
                      {"time_to_fix_s", nullptr},
                      {"distance_to_fix_m", nullptr}};
  if (counts.time_to_fix_s) summary["time_to_fix_s"] = *counts.time_to_fix_s;
  if (counts.distance_to_fix_m) summary["distance_to_fix_m"] = *counts.distance_to_fix_m;
  for (const auto& [what, count] : played.problems) summary["log: " + what] = number(count);
  for (const auto& [what, count] : report.counts) summary[what] = number(count);
  return summary;
}

void print_summary(const Session& session, const io::Summary& summary, const RunCounts& counts,
                   double cpu_seconds) {
  const double cpu_ms_per_scan =
      counts.scans == 0 ? 0.0 : 1e3 * cpu_seconds / static_cast<double>(counts.scans);
  if (session.json) {
    nlohmann::ordered_json json;
    for (const auto& [name, value] : summary)
      std::visit([&, &key = name](const auto& v) { json[key] = v; }, value);
    json["cpu_ms_per_scan"] = cpu_ms_per_scan;
    fmt::print("{}\n", json.dump());
    return;
  }
  if (session.quiet) return;
  const std::string fix = counts.distance_to_fix_m
                              ? fmt::format("first pose after {:.2f} m and {:.1f} s",
                                            *counts.distance_to_fix_m, *counts.time_to_fix_s)
                              : "no pose was found";
  fmt::print(
      "{}: {}; {} scans, {} field readings, {} odometry readings, {} estimates, {:.2f} ms CPU a scan\n",
      to_string(counts.last_status), fix, counts.scans, counts.field_readings, counts.odometry,
      counts.estimates, cpu_ms_per_scan);
  for (const auto& [name, value] : summary)
    if (const auto* count = std::get_if<std::int64_t>(&value);
        count != nullptr && name.find(' ') != std::string::npos)
      fmt::print("  {}: {}\n", name, *count);
}

Result<LocalizerFactory> make_factory(const Session& session, const Wish& wish, const Maps& maps) {
  MethodOptions options;
  options.two_step.initialise.distinct.count = wish.hypotheses;
  options.two_step.seed = session.seed;
  options.joint.localized_from = wish.localized_from;
  options.threads = session.threads;
  return make_method(wish.method, maps, options);
}

/// Nothing where the outputs destroy no input.
std::optional<Error> overwritten(const Wish& wish) {
  std::vector<fs::path> inputs = wish.logs, outputs{wish.output};
  inputs.insert(inputs.end(), {wish.map, wish.field});
  if (wish.calibration) inputs.push_back(*wish.calibration);
  if (wish.truth) inputs.push_back(*wish.truth);
  for (const auto& output : {wish.tum, wish.picture, wish.report})
    if (output) outputs.push_back(*output);
  return overwritten_input(outputs, inputs);
}

Result<Exit> localize(const Session& session, const Wish& wish) {
  if (auto error = overwritten(wish)) return *std::move(error);
  const Result<MagnetometerCalibration> calibration = load_calibration(wish.calibration);
  if (!calibration) return calibration.error();
  const Result<Maps> maps = load_maps(session, wish);
  if (!maps) return maps.error();
  const Result<LocalizerFactory> factory = make_factory(session, wish, *maps);
  if (!factory) return factory.error();
  Result<Output> output = open_output(wish);
  if (!output) return output.error();

  std::optional<RunLoop> loop;
  std::optional<RunReport> report_page;
  const auto on_header = [&](const io::RecordingHeader& header) {
    loop.emplace((*factory)(header.rig), [&](const Estimate& estimate) { output->write(estimate); });
    if (wish.report) report_page.emplace(header.rig);
  };
  Progress progress("localizing", session.quiet);
  const auto span = extent(wish.logs);
  const auto on_event = [&](const SensorEvent& event) {
    if (!loop) return false;
    loop->observe(event);
    if (report_page) report_page->observe(event);
    if (span) progress.show((stamp_of(event) - span->first) / span->second);
    return !interrupted() && !output->error;
  };
  const double before_s = cpu_s();
  io::PlayOptions play = wish.play;
  play.topics.imu.clear();
  play.calibration = *calibration;
  const Result<io::PlayReport> played = io::play(wish.logs, play, on_header, on_event);
  if (!played) return played.error();
  if (!loop) return Error(wish.logs.front().string() + ": the log holds no event; nothing to localize");

  const LocalizerReport report = loop->localizer().report();
  const io::Summary summary = summarise(wish, loop->counts(), *played, report, interrupted());
  output->close(summary);
  if (output->error) return *output->error;
  for (const auto* warnings : {&played->warnings, &report.warnings})
    for (const std::string& warning : *warnings) warn(session, warning);
  if (interrupted())
    return Error(fmt::format("interrupted; {} holds the {} estimates made so far", wish.output.string(),
                             loop->counts().estimates));
  const RunFiles files{wish.map, wish.field, wish.output, wish.truth};
  const std::string title = wish.logs.front().string();
  if (wish.picture)
    if (auto done = write_run_picture(files, title, *wish.picture); !done) return done.error();
  if (report_page)
    if (auto done = report_page->write(files, title, wish.method, *wish.report); !done) return done.error();
  print_summary(session, summary, loop->counts(), cpu_s() - before_s);
  return loop->counts().last_status == LocalizationStatus::kLocalized ? Exit::kDone : Exit::kNoFix;
}

}  // namespace

void add_localize(CLI::App& app, Session& session) {
  auto wish = std::make_shared<Wish>();
  CLI::App* command = app.add_subcommand("localize", "Find where the robot of a log is");
  command->add_option("--map", wish->map, "Occupancy map: a map_server yaml")->required();
  command->add_option("--field", wish->field, "Field map, as `mstsl map magnetic` makes it")->required();
  command->add_option("--method", wish->method, "How to localize")
      ->check(CLI::IsMember(method_names()))
      ->capture_default_str();
  command
      ->add_option(
          "-k,--hypotheses", wish->hypotheses,
          "Two-step method: initial hypotheses kept (the paper's K: 5 in its corridor, 8 in its car park)")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--probability", wish->localized_from,
                   "Joint method: a pose is published from this probability of being right on")
      ->check(CLI::Range(0.5, 0.999999))
      ->capture_default_str();
  command->add_option("-o,--output", wish->output, "Estimates, as JSON Lines")->required();
  command->add_option("--tum", wish->tum, "Also the trajectory, in the format that evo reads");
  command->add_option("--picture", wish->picture,
                      "Also a picture, PNG or SVG: the way on the map, with the field under it");
  command->add_option(
      "--report", wish->report,
      "Also a page, HTML, to look at the run again: scans, hypotheses and probability over time");
  command->add_option("--truth", wish->truth, "The true way, to be shown in picture and report");
  command
      ->add_option("logs", wish->logs,
                   "MCAP, rosbag2 folder, ROS 1 bag or CARMEN log; several are one after the other")
      ->required();
  add_calibration_option(*command, wish->calibration);
  add_topic_options(*command, wish->play);
  add_common_options(*command, session);
  command->callback(
      [wish, &session] { session.work = [wish, &session] { return localize(session, *wish); }; });
}

}  // namespace mstsl::app
