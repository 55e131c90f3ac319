#include "localize_log.hpp"

#include <ctime>
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

#include "estimates_output.hpp"
#include "interrupt.hpp"
#include "load_calibration.hpp"
#include "log_span.hpp"
#include "output_paths.hpp"
#include "progress.hpp"
#include "run_picture.hpp"
#include "run_report.hpp"
#include "warnings.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

/// CPU time of this process so far, in s.
double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

using Maps = std::shared_ptr<const LocalizationMaps>;

Result<Maps> load_maps(const Session& session, const LocalizeWish& wish) {
  Result<io::MapFile> map = io::read_map_file(wish.map);
  if (!map) return map.error();
  warn(session, map->warnings);
  Result<FieldMap> field = io::read_field_map(wish.field);
  if (!field) return field.error();
  Result<Maps> maps =
      make_localization_maps(std::move(map->grid), std::move(field).value(), {.threads = session.threads});
  if (!maps) return maps.error().within(fmt::format("{} with {}", wish.map.string(), wish.field.string()));
  return maps;
}

/// What the run says of itself. Only what follows from the input: the same run gives the same file.
io::Summary summarise(const LocalizeWish& wish, const RunCounts& counts, const io::PlayReport& played,
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

Result<LocalizerFactory> make_factory(const Session& session, const LocalizeWish& wish, const Maps& maps) {
  MethodOptions options;
  options.two_step.initialise.distinct.count = wish.hypotheses;
  options.two_step.seed = session.seed;
  options.joint.localized_from = wish.localized_from;
  options.threads = session.threads;
  return make_method(wish.method, maps, options);
}

/// Nothing where the outputs destroy no input.
std::optional<Error> overwritten(const LocalizeWish& wish) {
  std::vector<fs::path> inputs = wish.logs, outputs{wish.output};
  inputs.insert(inputs.end(), {wish.map, wish.field});
  if (wish.calibration) inputs.push_back(*wish.calibration);
  if (wish.truth) inputs.push_back(*wish.truth);
  for (const auto& output : {wish.tum, wish.picture, wish.report})
    if (output) outputs.push_back(*output);
  return overwritten_input(outputs, inputs);
}

}  // namespace

Result<Exit> localize_log(const Session& session, const LocalizeWish& wish) {
  if (auto error = overwritten(wish)) return *std::move(error);
  if (wish.truth && !wish.picture && !wish.report)
    warn(session, {"--truth is drawn in --picture and --report, and neither was asked for; to hold estimates "
                   "against the truth, run `mstsl evaluate`"});
  const Result<MagnetometerCalibration> calibration = load_calibration(wish.calibration);
  if (!calibration) return calibration.error();
  const Result<Maps> maps = load_maps(session, wish);
  if (!maps) return maps.error();
  const Result<LocalizerFactory> factory = make_factory(session, wish, *maps);
  if (!factory) return factory.error();
  Result<EstimatesOutput> output = EstimatesOutput::open(wish.output, wish.tum);
  if (!output) return output.error();

  std::optional<RunLoop> loop;
  std::optional<RunReport> report_page;
  const auto on_header = [&](const io::RecordingHeader& header) {
    loop.emplace((*factory)(header.rig), [&](const Estimate& estimate) { output->write(estimate); });
    if (wish.report) report_page.emplace(header.rig);
  };
  Progress progress("localizing", session.quiet);
  const auto span = span_of(wish.logs);
  const auto on_event = [&](const SensorEvent& event) {
    if (!loop) return false;
    loop->observe(event);
    if (report_page) report_page->observe(event);
    if (span) progress.show(span->share(stamp_of(event)));
    return !interrupted() && !output->error();
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
  if (output->error()) return *output->error();
  warn(session, played->warnings);
  warn(session, report.warnings);
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

}  // namespace mstsl::app
