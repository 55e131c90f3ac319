#include "located_drives.hpp"

#include <memory>
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
  for (const std::filesystem::path& log : logs) {
    const std::string what = fmt::format("finding {}", log.filename().string());
    const auto found = find_start(session, {log}, play, *maps, what);
    if (!found) return found.error();
    if (!*found)
      return Error(
          fmt::format("{}: the robot could not be found on the map; if you know where the log begins, give "
                      "--initial-pose",
                      log.string()));
    drives.found.push_back(**found);
    starts.push_back({walls, (*found)->anchor.map_T_base, (*found)->anchor.stamp});
  }
  Result<SurveyLogs> survey = read_survey(session, logs, play, starts);
  if (!survey) return survey.error();
  drives.survey = std::move(survey).value();
  return drives;
}

}  // namespace mstsl::app
