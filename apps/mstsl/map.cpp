#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"
#include "mstsl/viz/field_sheet.hpp"

#include "calibration_option.hpp"
#include "interrupt.hpp"
#include "map_report.hpp"
#include "output_paths.hpp"
#include "progress.hpp"
#include "session.hpp"
#include "survey_reader.hpp"
#include "topic_options.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

struct Wish {
  fs::path map;
  fs::path output;
  std::vector<fs::path> logs;
  std::vector<fs::path> checks;
  io::PlayOptions play;
  std::string initial_pose;
  std::string model = "gpr";
  std::string kernel = "auto";
  std::string quality = "fast";
  std::string bias = "auto";
  std::optional<fs::path> calibration;
  std::optional<fs::path> picture;
  FieldMapOptions build;
};

FieldMapOptions options_of(const Session& session, const Wish& wish) {
  FieldMapOptions options = wish.build;
  options.model = *field_model_from(wish.model);  // CLI11 lets only known names through
  options.quality = wish.quality == "exact" ? RegressionQuality::kExact : RegressionQuality::kFast;
  options.analysis.kernel = wish.kernel == "se"         ? KernelChoice::kSquaredExponential
                            : wish.kernel == "harmonic" ? KernelChoice::kHarmonic
                                                        : KernelChoice::kAuto;
  options.analysis.bias_removal = wish.bias == "keep"     ? BiasRemoval::kNever
                                  : wish.bias == "remove" ? BiasRemoval::kAlways
                                                          : BiasRemoval::kWhenSignificant;
  options.analysis.threads = options.threads = session.threads;
  return options;
}

/// Where the map comes from, without times and folders: the same input gives the same file.
std::vector<std::string> provenance(const Wish& wish) {
  std::vector<std::string> lines{
      fmt::format("mstsl {} map magnetic --model {} --kernel {} --quality {} --bias {} --resolution {}",
                  MSTSL_VERSION, wish.model, wish.kernel, wish.quality, wish.bias, wish.build.resolution_m)};
  lines.push_back("map " + wish.map.filename().string());
  if (wish.calibration) lines.push_back("calibration " + wish.calibration->filename().string());
  for (const fs::path& log : wish.logs) lines.push_back("log " + log.filename().string());
  return lines;
}

/// A drive that made the map cannot show how well it foretells another.
std::optional<Error> checked_by_itself(const Wish& wish) {
  for (const fs::path& check : wish.checks)
    for (const fs::path& log : wish.logs) {
      std::error_code ignored;  // one that is absent is complained of where it is read
      if (fs::equivalent(check, log, ignored))
        return Error(
            fmt::format("{} makes the map and cannot check it; give --check another drive", check.string()));
    }
  return std::nullopt;
}

/// Each log of its own: a drive on another day has another bias, and one bad drive should be seen as such.
Result<std::vector<CheckedLog>> check(const Session& session, const Wish& wish, const io::PlayOptions& play,
                                      const FieldMap& field) {
  std::vector<CheckedLog> checked;
  for (const fs::path& log : wish.checks) {
    const Result<SurveyLogs> drive = read_survey(session, {log}, play);
    if (!drive) return drive.error();
    checked.push_back({log.filename().string(), check_field_map(field, drive->fingerprints)});
  }
  return checked;
}

void warn(const Session& session, const std::vector<std::string>& sentences) {
  if (session.quiet) return;
  for (const std::string& sentence : sentences) fmt::print(stderr, "mstsl: warning: {}\n", sentence);
}

Result<FieldMap> build(const Session& session, const SurveyAnalysis& analysis, const OccupancyGrid& area,
                       FieldMapOptions options) {
  Progress progress("field map", session.quiet);
  options.progress = [&](double share) { progress.show(share); };
  return build_field_map(analysis, &area, options);
}

Result<Exit> map_magnetic(const Session& session, const Wish& wish) {
  std::vector<fs::path> inputs = wish.logs;
  inputs.insert(inputs.end(), wish.checks.begin(), wish.checks.end());
  inputs.push_back(wish.map);
  if (wish.calibration) inputs.push_back(*wish.calibration);
  std::vector<fs::path> outputs{wish.output};
  if (wish.picture) outputs.push_back(*wish.picture);
  if (auto error = overwritten_input(outputs, inputs)) return *std::move(error);
  if (!wish.initial_pose.empty())
    return Error("--initial-pose is not offered yet; give --pose-topic with the poses of the survey");
  if (auto error = checked_by_itself(wish)) return *std::move(error);
  const Result<io::MapFile> occupancy = io::read_map_file(wish.map);
  if (!occupancy) return occupancy.error();
  warn(session, occupancy->warnings);
  const Result<MagnetometerCalibration> calibration = load_calibration(wish.calibration);
  if (!calibration) return calibration.error();
  io::PlayOptions play = wish.play;
  play.calibration = *calibration;
  const Result<SurveyLogs> logs = read_survey(session, wish.logs, play);
  if (!logs) return logs.error();
  warn(session, logs->warnings);
  const std::string survey = fmt::format("the survey in {}{}", wish.logs.front().string(),
                                         wish.logs.size() > 1 ? " and others" : "");
  const FieldMapOptions options = options_of(session, wish);
  const auto analysis = analyse_survey(logs->fingerprints, options.model, options.analysis);
  if (!analysis) return analysis.error().within(survey);
  warn(session, analysis->warnings);
  Result<FieldMap> field = build(session, *analysis, occupancy->grid, options);
  if (!field) return field.error().within(survey);
  if (interrupted()) return Error("interrupted; nothing was written");
  field->height_m = logs->magnetometer_height_m;
  field->provenance = provenance(wish);
  const auto checked = check(session, wish, play, *field);
  if (!checked) return checked.error();
  if (const auto written = io::write_field_map(*field, wish.output); !written) return written.error();
  if (wish.picture) {
    const auto drawn =
        viz::draw_field(occupancy->grid, *field, "Magnetic field of " + wish.map.filename().string())
            .save(*wish.picture);
    if (!drawn) return drawn.error();
  }
  if (session.json)
    fmt::print("{}", map_report_json(*logs, *analysis, *field, *checked));
  else if (!session.quiet)
    fmt::print("{}written to {}\n", map_report_text(*logs, *analysis, *field, *checked),
               wish.output.string());
  return Exit::kDone;
}

void add_map_magnetic(CLI::App& map, Session& session) {
  auto wish = std::make_shared<Wish>();
  wish->play.topics.scan.clear();
  wish->play.topics.odometry.clear();
  wish->play.topics.imu.clear();
  CLI::App* command = map.add_subcommand("magnetic", "Make a magnetic field map from the logs of a survey");
  command->add_option("--map", wish->map, "Occupancy map: a map_server yaml")->required();
  auto* poses = command->add_option_group("poses", "Where the robot was during the survey");
  poses->add_option("--pose-topic", wish->play.topics.pose, "Topic with the robot's poses in the map");
  poses->add_option("--initial-pose", wish->initial_pose,
                    "X,Y,YAW (m, rad) at the start of each log; not offered yet");
  poses->require_option(1);
  command->add_option("--model", wish->model, "How the field between the fingerprints is made")
      ->check(CLI::IsMember({"gpr", "bilinear", "fingerprint"}))
      ->capture_default_str();
  command
      ->add_option("--kernel", wish->kernel,
                   "What gpr assumes of the field: se, three independent squared exponentials; harmonic, the "
                   "gradient of a potential; auto, what foretells held-out lanes better")
      ->check(CLI::IsMember({"se", "harmonic", "auto"}))
      ->capture_default_str();
  command
      ->add_option("--quality", wish->quality,
                   "Of the regression: fast (mean within 4 % of the noise) or exact (1 %)")
      ->check(CLI::IsMember({"fast", "exact"}))
      ->capture_default_str();
  command
      ->add_option("--bias", wish->bias,
                   "A magnetometer bias seen between opposite passes: remove where significant (auto), "
                   "always, or keep")
      ->check(CLI::IsMember({"auto", "remove", "keep"}))
      ->capture_default_str();
  add_calibration_option(*command, wish->calibration);
  command->add_option("--resolution", wish->build.resolution_m, "Side of a cell, m")
      ->check(CLI::Range(0.005, 10.0))
      ->capture_default_str();
  command->add_option("--field-topic", wish->play.topics.magnetic_field, "MagneticField messages")
      ->capture_default_str()
      ->group("Names in the log");
  command
      ->add_option("--tf-topic", wish->play.topics.transforms_static,
                   "TFMessage messages with the sensors' mounting")
      ->capture_default_str()
      ->group("Names in the log");
  command->add_option("--base-frame", wish->play.base_frame, "Frame of the robot's base")
      ->capture_default_str()
      ->group("Names in the log");
  command->add_option(
      "--check", wish->checks,
      "Logs of other drives, with poses too: how well the map foretells their field (it is not "
      "made from them)");
  command->add_option("--picture", wish->picture,
                      "Also a picture of it, PNG or SVG: components, strength, standard deviation, coverage");
  command->add_option("-o,--output", wish->output, "Field map, NetCDF")->required();
  command->add_option("logs", wish->logs, "MCAP, rosbag2 folder or ROS 1 bag; each is a session of its own")
      ->required();
  add_common_options(*command, session);
  command->callback(
      [wish, &session] { session.work = [wish, &session] { return map_magnetic(session, *wish); }; });
}

}  // namespace

void add_map(CLI::App& app, Session& session) {
  CLI::App* map = app.add_subcommand("map", "Make maps from the logs of a survey");
  map->require_subcommand(1);
  add_map_magnetic(*map, session);
}

}  // namespace mstsl::app
