#include "hard_run.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <optional>

#include "mstsl/core/angles.hpp"
#include "mstsl/sim/run.hpp"

#include "hard_crowd.hpp"
#include "hard_listener.hpp"

namespace mstsl {
namespace {

enum Stream : std::uint64_t { kDay = 1, kRoute, kDrive, kMount, kCrowd, kFollow, kCarry, kAfter, kLeg };
constexpr double kNearest_m = 5.0, kFarthest_m = 50.0;  // issue: moved 5-50 m
constexpr double kCarry_m_s = 1.0;
constexpr double kMostHidden = 0.3;  // issue: people hiding up to 30 % of the beams

Result<sim::Route> long_route(const sim::World& world, const sim::RunOptions& options, const Random& random) {
  const auto start = sim::random_waypoint(world, options, random.fork(kRoute));
  if (!start) return start.error();
  auto route = sim::tour_from(world, *start, options, random.fork(kLeg));
  if (route) route->start_yaw_rad = random.fork(kRoute).uniform(-kPi, kPi);
  return route;
}

/// A route that starts where somebody would set the robot down.
Result<sim::Route> route_after(const sim::World& world, const Eigen::Vector2d& from_m,
                               const sim::RunOptions& options, const Random& random) {
  constexpr std::uint64_t kTries = 200;
  for (std::uint64_t i = 0; i < kTries; ++i) {
    const auto place = sim::random_waypoint(world, options, random.fork(kCarry).fork(i));
    if (!place) return place.error();
    const double away_m = (*place - from_m).norm();
    if (away_m < kNearest_m || away_m > kFarthest_m) continue;
    auto route = sim::route_from(world, *place, options, random.fork(kAfter).fork(i));
    if (route) return route;
  }
  return Error("world '" + world.name() + "' has no place 5 to 50 m away to carry the robot to");
}

/// The heading nearest to the building's axes: what a commanded turn leads to.
double parallel(double yaw_rad, double axis_rad) {
  return yaw_rad - std::remainder(yaw_rad - axis_rad, radians(90.0));
}

/// Takes the simulator's events, lets people stand in the way, and hands them on.
class Stage {
 public:
  Stage(const HardBuilding& building, const sim::World& today, const sim::RobotOptions& robot,
        const Disturbance& disturbance, std::deque<HardListener>& listeners, ScanRecorder* scans,
        const Random& random)
      : today_(today),
        robot_(robot),
        field_(weakened(today, building.steel_share)),
        with_crowd_(disturbance.people),
        listeners_(listeners),
        scans_(scans),
        random_(random) {}

  void drive(const sim::Route& route, Stamp start, std::uint64_t part) {
    const Pose2 already = odom_T_base_;
    const sim::Trajectory way = sim::follow(route, robot_.motion, start, random_.fork(kFollow).fork(part));
    sim::drive(today_, robot_, way, random_.fork(kDrive),
               {[&](const SensorEvent& event) { take(event, already); },
                [&](const PoseReading& pose) { truth_.add(pose.stamp, pose.map_T_base); }},
               field_);
  }

  /// In the dark: wheels that do not turn, and nothing else, until `end`.
  void carry(Stamp end) {
    const double step_s = 1.0 / robot_.odometry.rate_hz;
    for (Stamp at = truth_.back().stamp + step_s; at < end; at = at + step_s)
      hand_on(OdometryReading{at, odom_T_base_});
  }

  const Trajectory& truth() const { return truth_; }

 private:
  void take(const SensorEvent& event, const Pose2& already) {
    if (const auto* odometry = std::get_if<OdometryReading>(&event)) {
      odom_T_base_ = already * odometry->odom_T_base;
      hand_on(OdometryReading{odometry->stamp, odom_T_base_});
    } else if (const auto* scan = std::get_if<LaserScan>(&event); scan && with_crowd_) {
      LaserScan hidden = *scan;
      if (!crowd_) {
        Random share = random_.fork(kCrowd);
        crowd_.emplace(share.uniform(0.1, kMostHidden), hidden, share.fork(1));
      }
      crowd_->hide(hidden, hidden.stamp.seconds());
      hand_on(hidden);
    } else {
      hand_on(event);
    }
  }

  void hand_on(const SensorEvent& event) {
    for (HardListener& listener : listeners_) listener.observe(event);
    if (scans_ != nullptr) scans_->observe(event);
  }

  const sim::World& today_;
  sim::RobotOptions robot_;
  sim::FieldSource field_;
  bool with_crowd_;
  std::deque<HardListener>& listeners_;
  ScanRecorder* scans_;  ///< nullptr: nobody looks
  Random random_;
  std::optional<Crowd> crowd_;
  Trajectory truth_;
  Pose2 odom_T_base_;
};

}  // namespace

Result<HardDrive> drive_hard_run(const HardBuilding& building, const std::vector<LocalizerFactory>& methods,
                                 const Disturbance& disturbance, const HardProtocolOptions& options,
                                 const Random& random, Traced traced) {
  const double before_ms = thread_cpu_ms();
  const sim::World today = day_of(building.surveyed, disturbance, random.fork(kDay));
  const sim::RobotOptions robot =
      robot_for(disturbance, options.scan_rate_hz, options.beams, random.fork(kMount));
  sim::RunOptions run;
  run.length_m = options.length_m;
  Result<sim::Route> route = options.set == CaseSet::kLong ? long_route(today, run, random.fork(kRoute))
                                                           : sim::random_run(today, run, random.fork(kRoute));
  if (!route) return route.error();
  if (!disturbance.heading) route->start_yaw_rad = parallel(route->start_yaw_rad, today.plan().axis_yaw_rad);

  std::deque<HardListener> listeners;
  for (const LocalizerFactory& method : methods) listeners.emplace_back(method(robot.rig), traced);
  std::optional<ScanRecorder> scans;
  if (traced == Traced::kYes) scans.emplace(robot.rig);
  Stage stage(building, today, robot, disturbance, listeners, scans ? &*scans : nullptr, random);
  stage.drive(*route, Stamp{}, 0);
  std::optional<Stamp> set_down;
  if (options.set == CaseSet::kKidnap) {
    const Eigen::Vector2d end_m = stage.truth().back().pose.position();
    const Result<sim::Route> after = route_after(today, end_m, run, random.fork(kAfter));
    if (!after) return after.error();
    set_down = stage.truth().back().stamp + (after->waypoints_m.front() - end_m).norm() / kCarry_m_s;
    stage.carry(*set_down);
    stage.drive(*after, *set_down, 1);
  }

  HardDrive drive;
  double methods_ms = 0.0;
  for (const HardListener& listener : listeners) {
    drive.records.push_back(listener.record(stage.truth(), set_down));
    methods_ms += listener.cpu_ms();
    if (scans) drive.trace.methods.push_back({"", listener.estimates()});
  }
  const double simulation_ms = thread_cpu_ms() - before_ms - methods_ms;
  for (HardRecord& record : drive.records) record.simulation_ms = simulation_ms;
  if (scans) {
    drive.trace.scans = scans->take();
    drive.trace.truth = stage.truth();
  }
  return drive;
}

}  // namespace mstsl
