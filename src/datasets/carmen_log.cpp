#include <utility>
#include <variant>

#include <fmt/format.h>

#include "mstsl/datasets/carmen.hpp"
#include "mstsl/io/recording.hpp"

namespace mstsl::datasets {
namespace {

void take(const SensorEvent& event, CarmenLog& log) {
  if (const auto* scan = std::get_if<LaserScan>(&event)) log.scans.push_back(*scan);
  if (const auto* pose = std::get_if<PoseReading>(&event)) log.corrected.push_back(*pose);
  if (const auto* odometry = std::get_if<OdometryReading>(&event)) log.odometry.push_back(*odometry);
}

/// Scans and poses pair up by stamp; one without the other is left out.
void pair_up(CarmenLog& log) {
  std::vector<LaserScan> scans;
  std::vector<PoseReading> corrected;
  auto pose = log.corrected.begin();
  for (LaserScan& scan : log.scans) {
    while (pose != log.corrected.end() && pose->stamp < scan.stamp) ++pose;
    if (pose == log.corrected.end() || pose->stamp != scan.stamp) continue;
    scans.push_back(std::move(scan));
    corrected.push_back(*pose++);
  }
  log.scans = std::move(scans);
  log.corrected = std::move(corrected);
}

}  // namespace

Result<CarmenLog> read_carmen_log(const std::filesystem::path& file) {
  CarmenLog log;
  io::PlayOptions options;
  options.topics.magnetic_field.clear();
  options.topics.imu.clear();
  options.topics.pose =
      "/corrected_pose";  // any name: a CARMEN log has no topics, only poses that are wanted or not
  const auto played = io::play(
      {file}, options, [&](const io::RecordingHeader& header) { log.rig = header.rig; },
      [&](const SensorEvent& event) { return take(event, log), true; });
  if (!played) return played.error();
  pair_up(log);
  if (log.scans.size() < 2)
    return Error(fmt::format("{}: only {} scans with a corrected pose; a *-corrected.log is wanted",
                             file.string(), log.scans.size()));
  return log;
}

}  // namespace mstsl::datasets
