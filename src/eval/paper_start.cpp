#include "paper_start.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "mstsl/eval/run_loop.hpp"
#include "mstsl/scan/line_fit.hpp"
#include "mstsl/sim/drive.hpp"

namespace mstsl {
namespace {

enum Stream : std::uint64_t { kRoute = 5, kDrive, kLine };

}  // namespace

Result<PaperStart> run_start(const PaperSetting& setting, const PaperProtocolOptions& options,
                             const TwoStepOptions& two_step, std::size_t number, Traced traced) {
  const int waypoint = static_cast<int>(number) / options.runs_per_waypoint;
  const int run = static_cast<int>(number) % options.runs_per_waypoint;
  const Random random = Random(options.seed).fork(1000 + number);
  const auto route = sim::route_from(setting.today, setting.waypoints_m[static_cast<std::size_t>(waypoint)],
                                     options.run, random.fork(kRoute));
  if (!route) return route.error();
  const Random drive_random = random.fork(kDrive);
  sim::RobotOptions robot = options.robot;
  const LaserScan seen = sim::first_scan(setting.today, robot, *route, Stamp{}, drive_random);
  Random line_random = random.fork(kLine);
  const auto line = fit_line(points_in_base(seen, robot.rig.base_T_laser), two_step.align.line, line_random);
  robot.motion.initial_turn_rad = line ? turn_parallel_to(*line) : 0.0;

  std::vector<std::vector<Estimate>> estimates(setting.maps.size());
  std::vector<RunLoop> loops;
  for (std::size_t m = 0; m < setting.maps.size(); ++m)
    loops.emplace_back(AnyLocalizer(TwoStep(setting.maps[m], robot.rig, two_step)),
                       [&estimates, m](const Estimate& estimate) { estimates[m].push_back(estimate); });
  Trajectory truth;
  std::optional<ScanRecorder> recorder;
  if (traced == Traced::kYes) recorder.emplace(robot.rig);
  sim::drive(setting.today, robot, *route, Stamp{}, drive_random,
             {[&](const SensorEvent& event) {
                if (recorder) recorder->observe(event);
                for (RunLoop& loop : loops) loop.observe(event);
              },
              [&](const PoseReading& pose) { truth.add(pose.stamp, pose.map_T_base); }});

  const double aligned_yaw = route->start_yaw_rad + robot.motion.initial_turn_rad;
  const double off_rad =
      std::abs(std::remainder(aligned_yaw - setting.today.plan().axis_yaw_rad, radians(90.0)));
  PaperStart start;
  for (std::size_t m = 0; m < setting.maps.size(); ++m)
    start.runs.push_back(
        {waypoint, run, options.models[m], off_rad, evaluate_run(estimates[m], truth, options.criteria)});
  if (!recorder) return start;
  start.trace = RunTrace{
      "waypoint " + std::to_string(waypoint + 1), setting.place, std::move(truth), recorder->take(), {}};
  for (std::size_t m = 0; m < setting.maps.size(); ++m)
    start.trace->methods.push_back({std::string(to_string(options.models[m])), std::move(estimates[m])});
  return start;
}

}  // namespace mstsl
