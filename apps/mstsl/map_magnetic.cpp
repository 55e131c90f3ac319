#include "map_magnetic.hpp"

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
#include "mstsl/viz/field_sheet.hpp"

#include "interrupt.hpp"
#include "load_calibration.hpp"
#include "map_report.hpp"
#include "output_paths.hpp"
#include "progress.hpp"
#include "survey_reader.hpp"
#include "warnings.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

FieldMapOptions options_of(const Session& session, const MagneticMapWish& wish) {
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
std::vector<std::string> provenance(const MagneticMapWish& wish) {
  std::vector<std::string> lines{
      fmt::format("mstsl {} map magnetic --model {} --kernel {} --quality {} --bias {} --resolution {}",
                  MSTSL_VERSION, wish.model, wish.kernel, wish.quality, wish.bias, wish.build.resolution_m)};
  lines.push_back("map " + wish.map.filename().string());
  if (wish.calibration) lines.push_back("calibration " + wish.calibration->filename().string());
  for (const fs::path& log : wish.logs) lines.push_back("log " + log.filename().string());
  return lines;
}

/// A drive that made the map cannot show how well it foretells another.
std::optional<Error> checked_by_itself(const MagneticMapWish& wish) {
  for (const fs::path& check : wish.checks)
    for (const fs::path& log : wish.logs) {
      std::error_code ignored;  // one that is absent is complained of where it is read
      if (fs::equivalent(check, log, ignored))
        return Error(
            fmt::format("{} makes the map and cannot check it; give --check another drive", check.string()));
    }
  return std::nullopt;
}

/// Without poses in the logs, where each of them begins.
Result<std::vector<KnownStart>> known_starts(const MagneticMapWish& wish, const OccupancyGrid& occupancy) {
  if (wish.initial_pose.empty()) return std::vector<KnownStart>();
  const Result<Pose2> pose = pose_from(wish.initial_pose);
  if (!pose) return pose.error().within("--initial-pose");
  if (count(occupancy, CellState::kOccupied) == 0)
    return Error(wish.map.string() + ": the map has no wall to track the survey by");
  return std::vector(wish.logs.size(), KnownStart{std::make_shared<const WallField>(occupancy), *pose});
}

/// Each log of its own: a drive on another day has another bias, and one bad drive should be seen as such.
Result<std::vector<CheckedLog>> check(const Session& session, const MagneticMapWish& wish,
                                      const io::PlayOptions& play, const std::vector<KnownStart>& starts,
                                      const FieldMap& field) {
  std::vector<CheckedLog> checked;
  for (const fs::path& log : wish.checks) {
    const std::vector<KnownStart> start(starts.begin(), starts.begin() + (starts.empty() ? 0 : 1));
    const Result<SurveyLogs> drive = read_survey(session, {log}, play, start);
    if (!drive) return drive.error();
    checked.push_back({log.filename().string(), check_field_map(field, drive->fingerprints)});
  }
  return checked;
}

Result<FieldMap> build(const Session& session, const SurveyAnalysis& analysis, const OccupancyGrid& area,
                       FieldMapOptions options) {
  Progress progress("field map", session.quiet);
  options.progress = [&](double share) { progress.show(share); };
  return build_field_map(analysis, &area, options);
}

}  // namespace

Result<Exit> map_magnetic(const Session& session, const MagneticMapWish& wish) {
  std::vector<fs::path> inputs = wish.logs;
  inputs.insert(inputs.end(), wish.checks.begin(), wish.checks.end());
  inputs.push_back(wish.map);
  if (wish.calibration) inputs.push_back(*wish.calibration);
  std::vector<fs::path> outputs{wish.output};
  if (wish.picture) outputs.push_back(*wish.picture);
  if (auto error = overwritten_input(outputs, inputs)) return *std::move(error);
  if (auto error = checked_by_itself(wish)) return *std::move(error);
  const Result<io::MapFile> occupancy = io::read_map_file(wish.map);
  if (!occupancy) return occupancy.error();
  warn(session, occupancy->warnings);
  const Result<MagnetometerCalibration> calibration = load_calibration(wish.calibration);
  if (!calibration) return calibration.error();
  io::PlayOptions play = wish.play;
  play.calibration = *calibration;
  const Result<std::vector<KnownStart>> starts = known_starts(wish, occupancy->grid);
  if (!starts) return starts.error();
  const Result<SurveyLogs> logs = read_survey(session, wish.logs, play, *starts);
  if (!logs) return logs.error();
  warn(session, logs->warnings);
  const std::string survey = fmt::format("the survey in {}{}", wish.logs.front().string(),
                                         wish.logs.size() > 1 ? " and others" : "");
  FieldMapOptions options = options_of(session, wish);
  options.drives = logs->drives;
  const auto analysis = analyse_survey(logs->fingerprints, options.model, options.analysis);
  if (!analysis) return analysis.error().within(survey);
  warn(session, analysis->warnings);
  Result<FieldMap> field = build(session, *analysis, occupancy->grid, options);
  if (!field) return field.error().within(survey);
  if (interrupted()) return Error("interrupted; nothing was written");
  field->height_m = logs->magnetometer_height_m;
  field->provenance = provenance(wish);
  const auto checked = check(session, wish, play, *starts, *field);
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

}  // namespace mstsl::app
