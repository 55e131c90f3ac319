#include "map_update.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"
#include "mstsl/magnetic/field_update.hpp"
#include "mstsl/viz/picture.hpp"

#include "interrupt.hpp"
#include "load_calibration.hpp"
#include "located_drives.hpp"
#include "output_paths.hpp"
#include "progress.hpp"
#include "update_report.hpp"
#include "warnings.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

/// The new map may be written over the old one: the old fingerprints are in it.
std::optional<Error> overwritten(const UpdateWish& wish) {
  std::vector<fs::path> inputs = wish.logs, outputs;
  inputs.push_back(wish.map);
  if (wish.calibration) inputs.push_back(*wish.calibration);
  if (wish.output) outputs.push_back(*wish.output);
  if (auto error = overwritten_input(outputs, inputs)) return error;
  inputs.push_back(wish.field);
  return wish.picture ? overwritten_input({*wish.picture}, inputs) : std::nullopt;
}

/// A map of before there were updates has one survey, of which neither logs nor dates are known.
void name_the_survey(FieldMap& field) {
  if (field.drives.empty()) field.drives = {{"the survey", {}, {}}};
}

Result<LocatedDrives> read_drives(const Session& session, const UpdateWish& wish, const io::PlayOptions& play,
                                  const OccupancyGrid& occupancy, const FieldMap& field) {
  if (play.topics.pose.empty() && wish.initial_pose.empty())
    return locate_drives(session, wish.logs, play, occupancy, field);
  std::vector<KnownStart> starts;
  if (!wish.initial_pose.empty()) {
    const Result<Pose2> pose = pose_from(wish.initial_pose);
    if (!pose) return pose.error().within("--initial-pose");
    starts.assign(wish.logs.size(), {std::make_shared<const WallField>(occupancy), *pose});
  }
  Result<SurveyLogs> survey = read_survey(session, wish.logs, play, starts);
  if (!survey) return survey.error();
  return LocatedDrives{std::move(survey).value(), {}};
}

/// A magnetometer higher or lower than the survey's sees another field.
void compare_heights(const FieldMap& field, SurveyLogs& survey) {
  constexpr double kMuch_m = 0.1;
  if (field.height_m != 0.0 && std::abs(field.height_m - survey.magnetometer_height_m) > kMuch_m)
    survey.warnings.push_back(
        fmt::format("the magnetometer is {:.2f} m above the floor, that of the map was {:.2f} m; the field "
                    "is another there",
                    survey.magnetometer_height_m, field.height_m));
}

Result<FieldMap> build(const Session& session, const FieldMap& old, const FieldUpdate& update,
                       const SurveyLogs& survey, const OccupancyGrid& occupancy) {
  FieldMapOptions options;
  options.model = old.model;
  options.resolution_m = old.geometry.resolution_m;
  options.analysis = analysis_as_before(old);
  options.threads = options.analysis.threads = session.threads;
  options.drives = old.drives;
  options.drives.insert(options.drives.end(), survey.drives.begin(), survey.drives.end());
  Progress progress("field map", session.quiet);
  options.progress = [&](double share) { progress.show(share); };
  Result<FieldMap> made = build_field_map(update.fingerprints, &occupancy, options);
  if (!made) return made.error();
  if (interrupted()) return Error("interrupted; nothing was written");
  made->height_m = old.height_m;
  made->replaced = update.replaced;
  std::vector<Fingerprint> used = survey.fingerprints;
  for (const DriveComparison& drive : update.drives)
    if (!drive.refused.empty())
      std::erase_if(used, [&](const Fingerprint& f) { return f.session == drive.session; });
  made->newest_drive = newest_drives(*made, old, used);
  made->provenance = old.provenance;
  made->provenance.push_back(fmt::format("mstsl {} map update", MSTSL_VERSION));
  for (const SurveyDrive& drive : survey.drives) made->provenance.push_back("log " + drive.name);
  return made;
}

/// The field, and where it is no longer what it was.
Result<void> draw_changes(const UpdateWish& wish, const OccupancyGrid& occupancy, const FieldMap& field,
                          const FieldUpdate& update) {
  viz::RunPicture picture;
  picture.title = fmt::format("What changed in {}", wish.map.filename().string());
  picture.field = &field;
  std::size_t changes = 0, drives = 0;
  for (const DriveComparison& drive : update.drives) {
    if (!drive.refused.empty()) continue;
    ++drives;
    for (const FieldChange& change : drive.changes) {
      ++changes;
      picture.places.push_back({change.center_m, fmt::format("{:.1f} uT", change.rms_uT.matrix().norm())});
    }
  }
  picture.subtitle =
      fmt::format("{} stretches along {} drives, by how much the field differs there", changes, drives);
  return viz::draw_run(occupancy, picture).save(*wish.picture);
}

}  // namespace

Result<Exit> map_update(const Session& session, const UpdateWish& wish) {
  if (auto error = overwritten(wish)) return *std::move(error);
  const Result<io::MapFile> occupancy = io::read_map_file(wish.map);
  if (!occupancy) return occupancy.error();
  warn(session, occupancy->warnings);
  Result<FieldMap> field = io::read_field_map(wish.field);
  if (!field) return field.error();
  name_the_survey(*field);
  const Result<MagnetometerCalibration> calibration = load_calibration(wish.calibration);
  if (!calibration) return calibration.error();
  io::PlayOptions play = wish.play;
  play.topics.imu.clear();
  play.calibration = *calibration;
  Result<LocatedDrives> drives = read_drives(session, wish, play, occupancy->grid, *field);
  if (!drives) return drives.error();
  compare_heights(*field, drives->survey);
  warn(session, drives->survey.warnings);
  for (Fingerprint& f : drives->survey.fingerprints) f.session += static_cast<int>(field->drives.size());
  const auto update = update_survey(*field, drives->survey.fingerprints);
  if (!update) return update.error().within(wish.field.string());
  const std::size_t first = field->drives.size();
  for (const DriveComparison& drive : update->drives)
    if (!drive.refused.empty())
      warn(session, {fmt::format("{} is left out: {}", name_of(*drives, drive, first), drive.refused)});
  std::optional<FieldMap> made;
  if (wish.output) {
    auto built = build(session, *field, *update, drives->survey, occupancy->grid);
    if (!built) return built.error().within(wish.field.string());
    made = std::move(built).value();
    if (auto written = io::write_field_map(*made, *wish.output); !written) return written.error();
  }
  if (wish.picture)
    if (auto drawn = draw_changes(wish, occupancy->grid, made ? *made : *field, *update); !drawn)
      return drawn.error();
  if (session.json)
    fmt::print("{}", update_report_json(*drives, *update, made, first));
  else if (!session.quiet)
    fmt::print("{}{}\n", update_report_text(*drives, *update, made, first),
               made ? "written to " + wish.output->string() : "nothing was written; give -o for a new map");
  return Exit::kDone;
}

}  // namespace mstsl::app
