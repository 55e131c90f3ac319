#include "mstsl/datasets/carmen.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "mstsl/datasets/track_log.hpp"
#include "mstsl/datasets/windows.hpp"
#include "mstsl/sim/drive.hpp"

namespace mstsl::datasets {
namespace {

constexpr std::uint64_t kWorldStream = 1;
constexpr std::uint64_t kSurveyStream = 2;
constexpr std::uint64_t kLaneStream = 3;
constexpr std::uint64_t kWindowStream = 4;
constexpr std::uint64_t kRunStream = 5;

Result<OccupancyGrid> map_of(const CarmenLog& log, std::size_t scans, const MappingOptions& options) {
  OccupancyMapper mapper(options);
  for (std::size_t i = 0; i < scans; ++i)
    if (const Result<void> drawn =
            mapper.insert(log.scans[i], log.rig.base_T_laser, log.corrected[i].map_T_base);
        !drawn)
      return drawn.error().within(fmt::format("scan {}", i));
  return mapper.grid();
}

/// The recorded robot's laser where the log has it, the magnetometer where the simulator's robot carries one.
Rig rig_of(const CarmenLog& log, const sim::RobotOptions& robot) {
  return {log.rig.base_T_laser, robot.rig.base_T_magnetometer};
}

/// Simulated drives along every lane of the map, one log each.
Result<std::vector<Log>> lane_surveys(const std::shared_ptr<const sim::World>& world,
                                      const CarmenOptions& options, Stamp start, const Random& random) {
  const auto routes = sim::survey_routes(*world, options.lanes);
  if (!routes) return routes.error();
  sim::RobotOptions robot = options.robot;
  robot.lidar.rate_hz = 0.0;
  std::vector<Log> logs;
  for (std::size_t i = 0; i < routes->size(); ++i)
    logs.push_back({robot.rig, [world, robot, start, route = (*routes)[i],
                                own = random.fork(i)](const sim::DriveSinks& sinks) {
                      sim::drive(*world, robot, route, start, own, sinks);
                    }});
  return logs;
}

std::string provenance(const std::filesystem::path& file, const CarmenOptions& options,
                       const Revisits& revisits, std::size_t lane_logs) {
  const std::string lanes =
      lane_logs == 0 ? "."
                     : fmt::format(",\n{} more along every lane of the map, driven both ways.", lane_logs);
  return fmt::format(R"(Made from {}, one of the Radish logs as redistributed in acschaefer/ple.

REAL: lidar and wheel odometry. The first {:.0f} m of the way make map.yaml from the log's corrected poses.
run_*.mcap are stretches of {:.0f} m of the later {:.0f} m, with the recorded scans and the odometry of the
wheels (with one reading more at each scan, between the recorded ones). Their truth is the log's corrected
poses, with the shape of the odometry between them. Of the later scans {:.0f} % were taken less than 1 m
from the first part's way; runs keep to the {} scans within {} m of that way, on mapped free ground and
{} m from mapped walls.

SIMULATED: the magnetic field, by steel placed over the mapped walls; noise {} uT, bias {} uT (SD per
axis). survey_00.mcap reads it along the first part's way{}
)",
                     file.filename().string(), revisits.first_m, options.runs.length_m, revisits.later_m,
                     100.0 * revisits.within_1m_share, revisits.revisiting, options.near_m,
                     options.clearance_m, options.robot.magnetometer.noise_uT,
                     options.robot.magnetometer.bias_sigma_uT, lanes);
}

}  // namespace

Result<Dataset> carmen(const std::filesystem::path& file, const CarmenOptions& options,
                       const Random& random) {
  const Result<CarmenLog> log = read_carmen_log(file);
  if (!log) return log.error();
  const std::size_t split = first_scan_after(log->corrected, options.mapped_share);
  Result<OccupancyGrid> map = map_of(*log, split, options.mapping);
  if (!map) return map.error().within(file.string());
  const Revisits revisits = find_revisits(log->corrected, *map, options);

  std::vector<Eigen::Vector2d> path_m;
  for (const PoseReading& pose : log->corrected) path_m.push_back(pose.map_T_base.position());
  const auto windows = draw_windows(windows_of_length(path_m, revisits.follows, options.runs.length_m),
                                    options.runs.count, random.fork(kWindowStream));
  if (!windows) return windows.error().within(file.string());

  Result<sim::World> built = sim::world_from_map(*map, options.world, random.fork(kWorldStream));
  if (!built) return built.error().within(file.string());
  const auto world = std::make_shared<const sim::World>(*std::move(built));
  const auto track = std::make_shared<const CorrectedTrack>(log->corrected, log->odometry);
  const Rig rig = rig_of(*log, options.robot);

  Dataset dataset;
  dataset.map = *std::move(map);
  dataset.surveys.push_back(track_log({track, log->corrected.front().stamp, log->corrected[split - 1].stamp},
                                      log->odometry, {}, world, rig, options.robot.magnetometer,
                                      random.fork(kSurveyStream)));
  if (options.drive_lanes) {
    Result<std::vector<Log>> lanes =
        lane_surveys(world, options, log->corrected.front().stamp, random.fork(kLaneStream));
    if (!lanes) return lanes.error().within(file.string());
    for (Log& lane : *lanes) dataset.surveys.push_back(std::move(lane));
  }
  dataset.provenance = provenance(file, options, revisits, dataset.surveys.size() - 1);
  for (std::size_t i = 0; i < windows->size(); ++i) {
    const auto [first, last] = (*windows)[i];
    dataset.runs.push_back(track_log({track, log->corrected[first].stamp, log->corrected[last].stamp},
                                     log->odometry, log->scans, world, rig, options.robot.magnetometer,
                                     random.fork(kRunStream).fork(i)));
  }
  return dataset;
}

}  // namespace mstsl::datasets
