// MRPT's two 2-D SLAM methods on a log that `mstsl map occupancy` maps too, held against the log's own poses
// by the same measures. See mrpt_slam.sh.
//
//   mrpt_slam icp|rbpf SETTINGS.ini LOG TRUTH_TOPIC
//
// The last line of stdout is the result; MRPT itself may say something before. (Its own programs icp-slam and
// rbpf-slam read a CARMEN log with all stamps alike, and then stand still.)
#include <cstdio>
#include <ctime>
#include <deque>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/core/Clock.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/random.h>
#include <mrpt/slam/CMetricMapBuilderICP.h>
#include <mrpt/slam/CMetricMapBuilderRBPF.h>

#include "mstsl/core/trajectory.hpp"
#include "mstsl/eval/trajectory_error.hpp"
#include "mstsl/io/recording.hpp"

namespace mstsl {
namespace {

struct Log {
  Rig rig;
  Trajectory odom_T_base;
  std::vector<LaserScan> scans;
  Trajectory map_T_base;
};

Result<Log> read(const std::string& file, const std::string& truth_topic) {
  Log log;
  io::PlayOptions options;
  options.topics.magnetic_field.clear();
  options.topics.imu.clear();
  options.topics.pose = truth_topic;
  const auto played = io::play(
      {file}, options, [&](const io::RecordingHeader& header) { log.rig = header.rig; },
      [&](const SensorEvent& event) {
        if (const auto* odometry = std::get_if<OdometryReading>(&event))
          log.odom_T_base.add(odometry->stamp, odometry->odom_T_base);
        if (const auto* scan = std::get_if<LaserScan>(&event)) log.scans.push_back(*scan);
        if (const auto* pose = std::get_if<PoseReading>(&event))
          log.map_T_base.add(pose->stamp, pose->map_T_base);
        return true;
      });
  if (!played) return played.error();
  return log;
}

mrpt::obs::CObservation2DRangeScan::Ptr observation_of(const LaserScan& scan, const Rig& rig) {
  auto observation = mrpt::obs::CObservation2DRangeScan::Create();
  const double aperture = scan.angle_increment_rad * static_cast<double>(scan.ranges_m.size() - 1);
  observation->aperture = static_cast<float>(aperture);
  observation->rightToLeft = true;
  observation->maxRange = static_cast<float>(scan.range_max_m);
  const Pose2 base_T_laser = to_pose2(rig.base_T_laser);
  observation->sensorPose = mrpt::poses::CPose3D(
      base_T_laser.x, base_T_laser.y, 0.0, base_T_laser.yaw + scan.angle_min_rad + 0.5 * aperture, 0.0, 0.0);
  observation->resizeScan(scan.ranges_m.size());
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const float range = scan.ranges_m[i];
    const bool valid = range >= scan.range_min_m && range < scan.range_max_m;
    observation->setScanRange(i, valid ? range : 0.0F);
    observation->setScanRangeValidity(i, valid);
  }
  return observation;
}

/// What a method is told at a scan: how the wheels say the robot moved since the last one, and what it sees.
struct Step {
  Stamp stamp;
  mrpt::obs::CActionCollection actions;
  mrpt::obs::CSensoryFrame frame;
};

std::vector<Step> steps_of(const Log& log) {
  std::vector<Step> steps;
  std::optional<Pose2> last;
  for (const LaserScan& scan : log.scans) {
    const auto odom_T_base = log.odom_T_base.at(scan.stamp, 10.0);
    if (!odom_T_base) continue;
    const Pose2 moved = last ? between(*last, *odom_T_base) : Pose2{};
    last = odom_T_base;
    Step& step = steps.emplace_back();
    step.stamp = scan.stamp;
    const mrpt::Clock::time_point stamp = mrpt::Clock::fromDouble(scan.stamp.seconds());
    mrpt::obs::CActionRobotMovement2D movement;
    movement.timestamp = stamp;
    movement.computeFromOdometry({moved.x, moved.y, moved.yaw}, {});
    step.actions.insert(movement);
    const auto observation = observation_of(scan, log.rig);
    observation->timestamp = stamp;
    step.frame.insert(observation);
  }
  return steps;
}

/// The poses at the scans as they were known at each: the method never goes back on one.
std::vector<TimedPose> icp_poses(std::vector<Step> steps, const mrpt::config::CConfigFile& settings) {
  mrpt::slam::CMetricMapBuilderICP builder;
  builder.ICP_params.loadFromConfigFile(settings, "ICP");
  builder.ICP_options.loadFromConfigFile(settings, "Mapping");
  builder.setVerbosityLevel(mrpt::system::LVL_ERROR);
  builder.initialize();
  std::vector<TimedPose> poses;
  for (Step& step : steps) {
    builder.processActionObservation(step.actions, step.frame);
    const mrpt::math::TPose3D mean = builder.getCurrentPoseEstimation()->getMeanVal().asTPose();
    poses.push_back({step.stamp, {mean.x, mean.y, mean.yaw}});
  }
  return poses;
}

/// The likeliest particle's way, once all is known.
std::vector<TimedPose> rbpf_poses(std::vector<Step> steps, const mrpt::config::CConfigFile& settings) {
  mrpt::slam::CMetricMapBuilderRBPF::TConstructionOptions options;
  options.loadFromConfigFile(settings, "Mapping");
  options.verbosity_level = mrpt::system::LVL_ERROR;
  mrpt::random::getRandomGenerator().randomize(1);
  mrpt::slam::CMetricMapBuilderRBPF builder(options);
  std::vector<Stamp> stamps;  // of the poses of the way: not every scan adds one
  std::deque<mrpt::math::TPose3D> way;
  for (Step& step : steps) {
    builder.processActionObservation(step.actions, step.frame);
    builder.getCurrentMostLikelyPath(way);
    while (stamps.size() < way.size()) stamps.push_back(step.stamp);
  }
  std::vector<TimedPose> poses;
  for (std::size_t i = 0; i < way.size(); ++i) poses.push_back({stamps[i], {way[i].x, way[i].y, way[i].yaw}});
  return poses;
}

std::string json_of(const RelationErrors& e) {
  return fmt::format(
      R"({{"count": {}, "translation_mean_m": {}, "translation_sd_m": {}, "rotation_mean_deg": {}, "rotation_sd_deg": {}}})",
      e.translation_m.count, e.translation_m.mean, e.translation_m.standard_deviation, e.rotation_deg.mean,
      e.rotation_deg.standard_deviation);
}

int main_of(const std::string& method, const std::string& settings_file, const std::string& file,
            const std::string& truth_topic) {
  const Result<Log> log = read(file, truth_topic);
  if (!log) return fmt::print(stderr, "{}\n", log.error().message()), 4;
  const mrpt::config::CConfigFile settings(settings_file);
  const std::clock_t before = std::clock();
  const std::vector<TimedPose> poses =
      method == "icp" ? icp_poses(steps_of(*log), settings) : rbpf_poses(steps_of(*log), settings);
  const double cpu_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  std::vector<TimedPose> estimated;
  std::vector<Pose2> truth;
  for (const TimedPose& pose : poses) {
    const auto at = log->map_T_base.at(pose.stamp, 0.5);
    constexpr double kApart_m = 0.1;  // as `mstsl map occupancy --truth-topic` thins them
    if (!at || (!truth.empty() && distance(truth.back(), *at) < kApart_m)) continue;
    estimated.push_back(pose);
    truth.push_back(*at);
  }
  if (truth.empty()) return fmt::print(stderr, "{}: no poses under {}\n", file, truth_topic), 4;
  fmt::print(R"({{"poses": {}, "cpu_s": {:.1f}, "rms_m": {}, "metre": {}, "loops": {}}})"
             "\n",
             truth.size(), cpu_s, trajectory_error(estimated, truth).rms_m,
             json_of(local_errors(estimated, truth)), json_of(loop_errors(estimated, truth)));
  return 0;
}

}  // namespace
}  // namespace mstsl

int main(int count, char** words) {
  if (count != 5 || (std::string(words[1]) != "icp" && std::string(words[1]) != "rbpf"))
    return std::fputs("usage: mrpt_slam icp|rbpf SETTINGS.ini LOG TRUTH_TOPIC\n", stderr), 2;
  return mstsl::main_of(words[1], words[2], words[3], words[4]);
}
