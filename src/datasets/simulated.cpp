#include "mstsl/datasets/simulated.hpp"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "mstsl/scan/line_fit.hpp"
#include "mstsl/scan/points.hpp"
#include "mstsl/sim/drive.hpp"
#include "mstsl/sim/occupancy_map.hpp"

namespace mstsl::datasets {
namespace {

enum Stream : std::uint64_t { kSurveys = 1, kDay, kRuns };
enum RunStream : std::uint64_t { kRoute = 1, kDrive, kLine };

/// 2024-01-01 00:00 UTC; each log starts an hour after the last.
constexpr std::int64_t kFirstStart_s = 1'704'067'200;
constexpr std::int64_t kBetweenLogs_s = 3600;

Stamp start_of(std::size_t log) {
  return Stamp::from_parts(kFirstStart_s + static_cast<std::int64_t>(log) * kBetweenLogs_s, 0);
}

Log log_of(std::shared_ptr<const sim::World> world, const sim::RobotOptions& robot, const sim::Route& route,
           Stamp start, const Random& random) {
  return {robot.rig,
          [=](const sim::DriveSinks& sinks) { sim::drive(*world, robot, route, start, random, sinks); }};
}

/// The paper's beta: how far the robot must turn to stand parallel to the line that most of its first scan
/// lies on.
double turn_to_wall(const LaserScan& scan, const Rig& rig, const Random& random) {
  Random own = random;
  const auto line = fit_line(points_in_base(scan, rig.base_T_laser), {}, own);
  return line ? turn_parallel_to(*line) : 0.0;
}

Result<Log> run_log(std::shared_ptr<const sim::World> world, const SimulatedOptions& options, Stamp start,
                    const Random& random) {
  const auto route = sim::random_run(*world, options.run, random.fork(kRoute));
  if (!route) return route.error();
  sim::RobotOptions robot = options.robot;
  const Random drive = random.fork(kDrive);
  if (options.turn_to_wall)
    robot.motion.initial_turn_rad =
        turn_to_wall(sim::first_scan(*world, robot, *route, start, drive), robot.rig, random.fork(kLine));
  return log_of(std::move(world), robot, *route, start, drive);
}

std::string provenance(const sim::World& world, const Dataset& dataset, double surveyed_m) {
  return fmt::format(
      "Everything here is simulated by `mstsl simulate`: world '{}', {} surveys ({:.0f} m driven) with the "
      "true pose on\n"
      "/ground_truth, {} runs whose truth is in truth_NN.csv (t in s, x and y in m, yaw in rad, frame map).\n"
      "Walls are line segments, the field is that of the Earth and of {} magnetised rods.\n",
      world.name(), dataset.surveys.size(), surveyed_m, dataset.runs.size(), world.field().pairs().size());
}

}  // namespace

Result<Dataset> simulated(const sim::World& world, const SimulatedOptions& options, const Random& random) {
  const auto routes = sim::survey_routes(world, options.survey);
  if (!routes) return routes.error();
  Dataset dataset;
  dataset.map = sim::occupancy_map(world, options.map_resolution_m);

  sim::RobotOptions surveyor = options.robot;
  surveyor.lidar.rate_hz = options.survey_scan_hz;
  const auto first_day = std::make_shared<const sim::World>(world);
  double surveyed_m = 0.0;
  for (std::size_t i = 0; i < routes->size(); ++i) {
    dataset.surveys.push_back(
        log_of(first_day, surveyor, (*routes)[i], start_of(i), random.fork(kSurveys).fork(i)));
    surveyed_m += length((*routes)[i]);
  }
  const auto later = std::make_shared<const sim::World>(
      sim::on_another_day(world, options.moved_fraction, random.fork(kDay)));
  for (std::size_t i = 0; i < options.runs; ++i) {
    auto log = run_log(later, options, start_of(routes->size() + i), random.fork(kRuns).fork(i));
    if (!log) return log.error();
    dataset.runs.push_back(std::move(log).value());
  }
  dataset.provenance = provenance(world, dataset, surveyed_m);
  return dataset;
}

}  // namespace mstsl::datasets
