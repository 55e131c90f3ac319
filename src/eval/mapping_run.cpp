#include "mapping_run.hpp"

#include <cmath>
#include <ctime>
#include <variant>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/eval/trajectory_error.hpp"
#include "mstsl/grid/distance_field.hpp"
#include "mstsl/mapping/slam.hpp"
#include "mstsl/mapping/track_drawer.hpp"

namespace mstsl {
namespace {

/// CPU time of this thread in s.
double thread_cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
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

}  // namespace

Result<MappingRecord> map_drive(const Recording& recording, const OccupancyGrid& true_map, bool with_field) {
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

}  // namespace mstsl
