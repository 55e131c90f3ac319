#include "mstsl/eval/mapping_protocol.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <mutex>
#include <variant>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/eval/trajectory_error.hpp"
#include "mstsl/grid/distance_field.hpp"
#include "mstsl/mapping/slam.hpp"
#include "mstsl/mapping/track_drawer.hpp"
#include "mstsl/sim/drive.hpp"
#include "mstsl/sim/occupancy_map.hpp"
#include "mstsl/sim/run.hpp"

namespace mstsl {
namespace {

constexpr std::uint64_t kWorldStream = 1, kTourStream = 2, kDriveStream = 3;

/// From place to place, each drawn by chance, on the shortest ways.
Result<sim::Route> tour(const sim::World& world, double length_m, const Random& random) {
  sim::Route route;
  auto at = sim::random_waypoint(world, {}, random.fork(0));
  if (!at) return at.error();
  route.waypoints_m.push_back(*at);
  for (std::uint64_t k = 1; sim::length(route) < length_m; ++k) {
    const auto to = sim::random_waypoint(world, {}, random.fork(k));
    if (!to) return to.error();
    const auto way = sim::plan_path(world, route.waypoints_m.back(), *to);
    if (!way) return way.error();
    route.waypoints_m.insert(route.waypoints_m.end(), way->begin() + 1, way->end());
  }
  const Eigen::Vector2d first = route.waypoints_m[1] - route.waypoints_m[0];
  route.start_yaw_rad = std::atan2(first.y(), first.x());
  return sim::truncated(route, length_m);
}

/// What the sensors said on a drive, and the truth.
struct Recording {
  Rig rig;
  std::vector<SensorEvent> events;
  Trajectory truth;
};

/// CPU time of this thread in s.
double thread_cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Result<sim::RobotOptions> robot_named(const std::string& name) {
  sim::RobotOptions robot;
  if (name == "good") {
    robot.lidar.rate_hz = 10.0, robot.lidar.beams = 541;
    return robot;
  }
  if (name != "cheap") return Error(fmt::format("there is no robot '{}'; there are good and cheap", name));
  robot.lidar = {.rate_hz = 5.5,
                 .field_of_view_rad = radians(359.0),
                 .beams = 360,
                 .sweep_s = 0.18,
                 .range_max_m = 8.0,
                 .near_noise_m = 0.02};
  robot.odometry.scale_sigma = 0.06;
  robot.odometry.drift_sigma_rad_per_m = radians(2.0);
  return robot;
}

Result<Recording> record(const sim::World& world, const std::string& robot_name,
                         const MappingProtocolOptions& options, const Random& random) {
  const auto route = tour(world, options.length_m, random.fork(kTourStream));
  if (!route) return route.error();
  const Result<sim::RobotOptions> robot = robot_named(robot_name);
  if (!robot) return robot.error();
  Recording recording{.rig = robot->rig, .events = {}, .truth = {}};
  sim::drive(world, *robot, *route, Stamp{}, random.fork(kDriveStream),
             {[&](const SensorEvent& event) { recording.events.push_back(event); },
              [&](const PoseReading& pose) { recording.truth.add(pose.stamp, pose.map_T_base); }});
  return recording;
}

constexpr double kWrong_m = 0.5, kWrong_rad = radians(10.0), kLongestGap_s = 1.0;

bool is_wrong(const Closure& closure, const SlamTrack& track, const Trajectory& truth) {
  const auto from = truth.at(track.keyframes[closure.from].stamp, kLongestGap_s);
  const auto to = truth.at(track.keyframes[closure.to].stamp, kLongestGap_s);
  if (!from || !to) return false;
  const Pose2 true_motion = between(*from, *to);
  return distance(true_motion, closure.from_T_to) > kWrong_m ||
         std::abs(angle_between(true_motion.yaw, closure.from_T_to.yaw)) > kWrong_rad;
}

/// Share of the map's occupied cells farther than 0.2 m from every true surface.
double map_error(const Recording& recording, const SlamTrack& track, const Pose2& true_T_map,
                 const OccupancyGrid& true_map) {
  constexpr double kFar_m = 0.2;
  TrackDrawer drawer;
  drawer.begin_drive(recording.rig, track.drives.front().map_T_base);
  for (const SensorEvent& event : recording.events)
    if (const auto* scan = std::get_if<LaserScan>(&event)) drawer.observe(*scan);
  const Result<OccupancyGrid> grid = drawer.grid();
  if (!grid) return 1.0;
  const OccupancyGrid& drawn = *grid;
  const DistanceField true_walls(true_map, 1.0);
  Rate far;
  for (std::size_t i = 0; i < drawn.geometry().size(); ++i)
    if (drawn.values()[i] == CellState::kOccupied)
      far.add(true_walls.at(true_T_map * drawn.geometry().center_of(drawn.geometry().cell(i))) > kFar_m);
  return far.share();
}

Result<MappingRecord> mapped(const Recording& recording, const OccupancyGrid& true_map, bool with_field) {
  SlamOptions options;
  options.loops.use_field = with_field;
  const double begun_s = thread_cpu_s();
  Slam slam(options);
  slam.begin_drive(recording.rig);
  for (const SensorEvent& event : recording.events)
    std::visit(
        [&](const auto& reading) {
          if constexpr (requires { slam.observe(reading); }) slam.observe(reading);
        },
        event);
  const Result<SlamTrack> track = slam.track();
  if (!track) return track.error();
  MappingRecord record;
  record.cpu_s = thread_cpu_s() - begun_s;
  record.with_field = with_field;
  record.driven_m = track->way_m();
  record.driven_s = recording.truth.back().stamp - recording.truth.front().stamp;
  record.closures = track->closures.size();
  for (const Closure& c : track->closures) {
    record.refuted += c.refuted ? 1 : 0;
    record.wrong_closures += !c.refuted && is_wrong(c, *track, recording.truth) ? 1 : 0;
  }
  record.ambiguous = track->loops.ambiguous;
  record.refused_by_field = track->loops.refused_by_field;
  record.closed_only_with_field = track->loops.earlier_by_field;
  std::vector<TimedPose> estimated;
  std::vector<Pose2> truth;
  for (const SlamTrack::Keyframe& k : track->keyframes)
    if (const auto at = recording.truth.at(k.stamp, kLongestGap_s))
      estimated.push_back({k.stamp, k.map_T_base}), truth.push_back(*at);
  const TrajectoryError error = trajectory_error(estimated, truth);
  record.ate_rms_m = error.rms_m, record.ate_max_m = error.max_m;
  record.map_error = map_error(recording, *track, error.true_T_map, true_map);
  return record;
}

}  // namespace

std::vector<std::string> mapping_robot_names() { return {"good", "cheap"}; }

Result<std::vector<MappingRecord>> run_mapping_protocol(const MappingProtocolOptions& options) {
  const std::size_t places = options.worlds.size() * static_cast<std::size_t>(options.runs);
  const std::size_t runs = places * options.robots.size();
  std::vector<Result<std::vector<MappingRecord>>> made(runs, Error("not made"));
  std::mutex lock;
  std::size_t done = 0;
  bool ended = false;
  parallel_for(runs, options.threads, [&](std::size_t i) {
    {
      const std::lock_guard guard(lock);
      if (ended) return;
    }
    const std::size_t place = i % places;
    const std::string& robot = options.robots[i / places];
    const std::string& name = options.worlds[place / static_cast<std::size_t>(options.runs)];
    const int run = static_cast<int>(place % static_cast<std::size_t>(options.runs));
    const Random random = Random(options.seed).fork(place);
    made[i] = [&]() -> Result<std::vector<MappingRecord>> {
      const auto world = sim::make_world(name, {}, random.fork(kWorldStream));
      if (!world) return world.error();
      const auto recording = record(*world, robot, options, random);
      if (!recording) return recording.error().within(name);
      const OccupancyGrid true_map = sim::occupancy_map(*world);
      std::vector<MappingRecord> records;
      for (const bool with_field : {false, true}) {
        auto record = mapped(*recording, true_map, with_field);
        if (!record) return record.error().within(name);
        record->world = name, record->robot = robot, record->run = run;
        records.push_back(*record);
      }
      return records;
    }();
    const std::lock_guard guard(lock);
    ++done;
    if (options.progress && !options.progress(static_cast<double>(done) / static_cast<double>(runs)))
      ended = true;
  });
  if (ended) return Error("interrupted; nothing was written");
  std::vector<MappingRecord> records;
  for (auto& some : made) {
    if (!some) return some.error();
    records.insert(records.end(), some->begin(), some->end());
  }
  return records;
}

}  // namespace mstsl
