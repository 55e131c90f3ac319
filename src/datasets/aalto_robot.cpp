#include "mstsl/datasets/aalto_robot.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "mstsl/datasets/number_columns.hpp"

namespace mstsl::datasets {
namespace {

constexpr int kSurveys = 4, kDrives = 9;

/// The recordings' clocks start near zero; a stamp must not be.
constexpr Stamp kStart = Stamp::from_parts(1'000'000'000, 0);

constexpr const char* kProvenance =
    R"(Made from AaltoML/magnetic-data (aalto-robot); cite Solin et al., IEEE Transactions on Robotics 2018.

REAL: positions (motion capture) and the magnetic field (calibrated, the robot's heading removed, so that every pose
here has heading 0). survey_00 to survey_03 are drives 1 to 4, check_00 is drive 5 in the same room, check_01 to
check_04 are drives 6 to 9 after steel shelves were brought in.

There are no runs: nothing was recorded of lidar, odometry or heading. The map is not one of walls; it is free where
a drive came near.
)";

/// One drive, a pose and a reading at each stamp.
struct Drive {
  std::vector<PoseReading> poses;
  std::vector<FieldReading> readings;
};

Result<Drive> read_drive(const std::filesystem::path& folder, int number) {
  const auto file = [&](const char* what) { return folder / fmt::format("{}-{}.csv", number, what); };
  const auto places = read_number_rows(file("loc"), 2), fields = read_number_rows(file("mag"), 3),
             times = read_number_rows(file("time"), 1);
  for (const auto* columns : {&places, &fields, &times})
    if (!*columns) return columns->error();
  const auto& seconds = (*times)[0];
  if ((*places)[0].size() != seconds.size() || (*fields)[0].size() != seconds.size())
    return Error(fmt::format("{}: drive {} has {} positions, {} readings and {} times; is a file cut off?",
                             folder.string(), number, (*places)[0].size(), (*fields)[0].size(),
                             seconds.size()));
  Drive drive;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    const Stamp stamp = kStart + seconds[i];
    drive.poses.push_back({stamp, {(*places)[0][i], (*places)[1][i], 0.0}});
    drive.readings.push_back({stamp, {(*fields)[0][i], (*fields)[1][i], (*fields)[2][i]}});
  }
  return drive;
}

Log log_of(Drive drive) {
  return {Rig{}, [drive = std::make_shared<const Drive>(std::move(drive))](const sim::DriveSinks& sinks) {
            for (std::size_t i = 0; i < drive->poses.size(); ++i) {
              if (sinks.truth) sinks.truth(drive->poses[i]);
              if (sinks.event) sinks.event(drive->readings[i]);
            }
          }};
}

}  // namespace

Result<Dataset> aalto_robot(const std::filesystem::path& folder, const TubeOptions& area) {
  Dataset dataset;
  dataset.provenance = kProvenance;
  std::vector<Path> paths_m;
  for (int number = 1; number <= kDrives; ++number) {
    Result<Drive> drive = read_drive(folder, number);
    if (!drive) return drive.error();
    for (Path& path = paths_m.emplace_back(); const PoseReading& pose : drive->poses)
      path.push_back(pose.map_T_base.position());
    (number <= kSurveys ? dataset.surveys : dataset.checks).push_back(log_of(*std::move(drive)));
  }
  Result<OccupancyGrid> map = tubes_around(paths_m, area);
  if (!map) return map.error().within(folder.string());
  dataset.map = *std::move(map);
  return dataset;
}

}  // namespace mstsl::datasets
