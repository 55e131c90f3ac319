#include <filesystem>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"
#include "mstsl/viz/field_sheet.hpp"

#include "drive_report.hpp"
#include "interrupt.hpp"
#include "map_occupancy.hpp"
#include "map_report.hpp"
#include "progress.hpp"
#include "survey_reader.hpp"
#include "warnings.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

/// The field along the ways driven, and what the survey shows of itself.
struct MappedField {
  SurveyLogs survey;
  SurveyAnalysis analysis;
  FieldMap field;
};

Result<MappedField> map_field(const Session& session, const WholeMapWish& wish, const MappedDrives& mapped) {
  std::vector<Trajectory> tracks;
  for (const DriveTrack& drive : mapped.track.drives) tracks.push_back(drive.map_T_base);
  // One drive in several files has one trajectory, which holds for each of them.
  while (tracks.size() < wish.drives.logs.size()) tracks.push_back(tracks.back());
  auto survey = collect_fingerprints(session, wish.drives.logs, mapped.play, tracks);
  if (!survey) return survey.error();
  FieldMapOptions options;
  options.threads = options.analysis.threads = session.threads;
  options.drives = survey->drives;
  const std::string where =
      wish.drives.logs.front().string() + (wish.drives.logs.size() > 1 ? " and others" : "");
  auto analysis = analyse_survey(survey->fingerprints, options.model, options.analysis);
  if (!analysis) return analysis.error().within(where);
  Progress progress("field map", session.quiet);
  options.progress = [&](double share) { progress.show(share); };
  auto field = build_field_map(*analysis, &mapped.grid, options);
  if (!field) return field.error().within(where);
  if (interrupted()) return Error("interrupted; nothing was written");
  field->height_m = survey->magnetometer_height_m;
  field->provenance = {fmt::format("mstsl {} map all", MSTSL_VERSION)};
  for (const fs::path& log : wish.drives.logs) field->provenance.push_back("log " + log.filename().string());
  return MappedField{std::move(survey).value(), std::move(analysis).value(), std::move(field).value()};
}

Result<void> write_all(const WholeMapWish& wish, const MappedDrives& mapped,
                       const std::optional<MappedField>& field) {
  const fs::path& folder = wish.folder;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error(fmt::format("{}: cannot make the folder: {}", folder.string(), error.message()));
  const std::string title = "Map of " + wish.drives.logs.front().filename().string();
  if (auto written = io::write_map(mapped.grid, folder / "map.yaml"); !written) return written;
  if (auto written = write_ways(mapped, folder / "trajectory.tum"); !written) return written;
  if (field) {
    if (auto written = io::write_field_map(field->field, folder / "field.nc"); !written) return written;
    if (auto written = viz::draw_field(mapped.grid, field->field, title).save(folder / "field.png"); !written)
      return written;
  }
  if (auto written = draw_ways(mapped, field ? &field->field : nullptr, title).save(folder / "map.png");
      !written)
    return written;
  return io::write_file(folder / "report.json", drive_report_json(mapped) + "\n");
}

}  // namespace

Result<Exit> map_all(const Session& session, const WholeMapWish& wish) {
  Result<MappedDrives> mapped = map_drives(session, wish.drives);
  if (!mapped) return mapped.error();
  std::optional<MappedField> field;
  if (mapped->play.topics.magnetic_field.empty()) {
    mapped->warnings.push_back(
        fmt::format("no field map is made: not every log has magnetic field messages under {}",
                    wish.drives.play.topics.magnetic_field));
  } else {
    Result<MappedField> made = map_field(session, wish, *mapped);
    if (!made) return made.error();
    field = std::move(made).value();
    for (const std::string& warning : field->analysis.warnings) mapped->warnings.push_back(warning);
  }
  warn(session, mapped->warnings);
  if (const auto written = write_all(wish, *mapped, field); !written) return written.error();
  if (session.json) {
    fmt::print("{}\n", drive_report_json(*mapped));
  } else if (!session.quiet) {
    fmt::print("{}", drive_report_text(*mapped));
    if (field) fmt::print("\n{}", map_report_text(field->survey, field->analysis, field->field, {}));
    fmt::print("written to {}: map.yaml, {}trajectory.tum, report.json and pictures\n", wish.folder.string(),
               field ? "field.nc, " : "");
  }
  return Exit::kDone;
}

}  // namespace mstsl::app
