#include "mstsl/eval/paper_protocol.hpp"

#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "mstsl/eval/run_loop.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"
#include "mstsl/scan/line_fit.hpp"
#include "mstsl/sim/drive.hpp"
#include "mstsl/sim/occupancy_map.hpp"

namespace mstsl {
namespace {

enum Stream : std::uint64_t { kWorld = 1, kSurvey, kDay, kWaypoint, kRoute, kDrive, kLine };

using Maps = std::shared_ptr<const LocalizationMaps>;

/// Tells of progress from any thread, and remembers that an end was asked for.
class Teller {
 public:
  explicit Teller(const PaperProtocolOptions& options) : progress_(options.progress) {}
  void tell(const char* what, double share) {
    const std::scoped_lock lock(mutex_);
    if (progress_ && !stopped_ && !progress_(what, share)) stopped_ = true;
  }
  bool stopped() const { return stopped_; }

 private:
  std::function<bool(const char*, double)> progress_;
  std::mutex mutex_;
  std::atomic<bool> stopped_ = false;
};

Error interrupted() { return Error("the protocol was interrupted before its end; nothing was written"); }

/// Everything that all runs share.
struct Setting {
  sim::World today;
  std::vector<Maps> maps;  ///< by model
  std::shared_ptr<const TracedPlace> place;
  std::vector<Eigen::Vector2d> waypoints_m;
  std::size_t fingerprints = 0;
};

struct AllMaps {
  std::vector<Maps> by_model;
  std::shared_ptr<const TracedPlace> place;
};

Result<AllMaps> make_maps(const sim::World& world, const std::vector<Fingerprint>& fingerprints,
                          const PaperProtocolOptions& options, Teller& teller) {
  const OccupancyGrid occupancy = sim::occupancy_map(world);
  AllMaps maps;
  for (const FieldModel model : options.models) {
    FieldMapOptions build;
    build.model = model;
    build.analysis.kernel = KernelChoice::kSquaredExponential;  // the paper's Gaussian kernel
    build.threads = options.threads;
    build.progress = [&](double share) { teller.tell("field map", share); };
    Result<FieldMap> field = build_field_map(fingerprints, &occupancy, build);
    if (!field) return field.error();
    if (teller.stopped()) return interrupted();
    if (!maps.place)
      maps.place = std::make_shared<const TracedPlace>(TracedPlace{options.world, occupancy, *field});
    auto both = make_localization_maps(occupancy, std::move(field).value(), {.threads = options.threads});
    if (!both) return both.error();
    maps.by_model.push_back(std::move(both).value());
  }
  return maps;
}

Result<Setting> prepare(const PaperProtocolOptions& options, const Random& random, Teller& teller) {
  Result<sim::World> world = sim::make_world(options.world, {}, random.fork(kWorld));
  if (!world) return world.error();
  teller.tell("survey", 0.0);
  SimulatedSurveyOptions survey = options.survey;
  survey.threads = options.threads;
  const auto fingerprints = simulate_survey(*world, survey, random.fork(kSurvey));
  if (!fingerprints) return fingerprints.error();
  auto maps = make_maps(*world, *fingerprints, options, teller);
  if (!maps) return maps.error();
  Setting setting{sim::on_another_day(*world, options.moved_fraction, random.fork(kDay)),
                  std::move(maps->by_model),
                  std::move(maps->place),
                  {},
                  fingerprints->size()};
  for (int i = 0; i < options.waypoints; ++i) {
    const auto waypoint = sim::random_waypoint(setting.today, options.run,
                                               random.fork(kWaypoint).fork(static_cast<std::uint64_t>(i)));
    if (!waypoint) return waypoint.error();
    setting.waypoints_m.push_back(*waypoint);
  }
  return setting;
}

/// What one start gave.
struct Start {
  std::vector<ProtocolRun> runs;  ///< by model
  std::optional<RunTrace> trace;  ///< of the first from its waypoint
};

/// One start: the robot aligns itself, drives, and every model's localizer hears the same events.
Result<Start> run_once(const Setting& setting, const PaperProtocolOptions& options,
                       const TwoStepOptions& two_step, const Random& random, int waypoint, int run) {
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
  if (run == 0) recorder.emplace(robot.rig);
  sim::drive(setting.today, robot, *route, Stamp{}, drive_random,
             {[&](const SensorEvent& event) {
                if (recorder) recorder->observe(event);
                for (RunLoop& loop : loops) loop.observe(event);
              },
              [&](const PoseReading& pose) { truth.add(pose.stamp, pose.map_T_base); }});

  const double aligned_yaw = route->start_yaw_rad + robot.motion.initial_turn_rad;
  const double off_rad =
      std::abs(std::remainder(aligned_yaw - setting.today.plan().axis_yaw_rad, radians(90.0)));
  Start start;
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

}  // namespace

Result<ProtocolResult> run_paper_protocol(const PaperProtocolOptions& options) {
  TwoStepOptions two_step = options.two_step;
  two_step.initialise.distinct.count = options.hypotheses.value_or(options.world == "corridor" ? 5 : 8);
  if (auto error = invalid(two_step)) return *error;
  Teller teller(options);
  const Random random(options.seed);
  const Result<Setting> setting = prepare(options, random, teller);
  if (!setting) return setting.error();

  const auto starts = static_cast<std::size_t>(options.waypoints * options.runs_per_waypoint);
  std::vector<std::optional<Result<Start>>> done(starts);
  std::atomic<std::size_t> finished = 0;
  parallel_for(starts, options.threads, [&](std::size_t i) {
    if (teller.stopped()) return;
    const int waypoint = static_cast<int>(i) / options.runs_per_waypoint;
    const int run = static_cast<int>(i) % options.runs_per_waypoint;
    done[i] = run_once(*setting, options, two_step, random.fork(1000 + i), waypoint, run);
    teller.tell("runs", static_cast<double>(++finished) / static_cast<double>(starts));
  });
  if (teller.stopped()) return interrupted();

  ProtocolResult result{options.world,         options.seed,   two_step.initialise.distinct.count,
                        setting->fingerprints, options.models, {},
                        setting->waypoints_m,  setting->place, {}};
  for (auto& start : done) {
    if (!*start) return start->error();
    for (ProtocolRun& run : (*start)->runs) result.runs.push_back(std::move(run));
    if ((*start)->trace) result.traces.push_back(*std::move((*start)->trace));
  }
  return result;
}

}  // namespace mstsl
