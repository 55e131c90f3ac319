#include "located_drives.hpp"

#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace mstsl::app {

Result<LocatedDrives> locate_drives(const Session& session, const std::vector<std::filesystem::path>& logs,
                                    const io::PlayOptions& play, const OccupancyGrid& occupancy,
                                    const FieldMap& field) {
  const auto maps = make_localization_maps(occupancy, field, {.threads = session.threads});
  if (!maps) return maps.error();
  const auto walls = std::make_shared<const WallField>(occupancy);
  LocatedDrives drives;
  std::vector<KnownStart> starts;
  std::vector<std::filesystem::path> found_logs;
  std::vector<std::string> warnings;
  for (const std::filesystem::path& log : logs) {
    const std::string what = fmt::format("finding {}", log.filename().string());
    const auto found = find_start(session, {log}, play, *maps, what);
    if (!found) return found.error();
    if (!*found) {
      warnings.push_back(fmt::format(
          "{}: the robot could not be found on the map, and the log is left out; if you know where it "
          "begins, give --initial-pose",
          log.string()));
      continue;
    }
    found_logs.push_back(log);
    drives.found.push_back(**found);
    starts.push_back({walls, (*found)->anchor.map_T_base, (*found)->anchor.stamp});
  }
  if (found_logs.empty()) return Error(warnings.front());
  Result<SurveyLogs> survey = read_survey(session, found_logs, play, starts);
  if (!survey) return survey.error();
  drives.survey = std::move(survey).value();
  drives.survey.warnings.insert(drives.survey.warnings.begin(), warnings.begin(), warnings.end());
  return drives;
}

}  // namespace mstsl::app
