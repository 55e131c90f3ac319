// How near the positions of a simulated survey that was tracked on its map come to the true ones, and what
// that does to the field map: both maps, from tracked and from true positions, foretell drives that made
// neither.
//
//   survey_positions FOLDER
//
// FOLDER is one of `mstsl simulate`, its surveys with scans and its runs as the drives foretold. See
// tools/survey_positions.sh.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "mstsl/io/map_server.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/io/truth.hpp"
#include "mstsl/magnetic/field_check.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"
#include "mstsl/magnetic/fingerprint_collector.hpp"
#include "mstsl/mapping/survey_tracker.hpp"

namespace mstsl {
namespace {

namespace fs = std::filesystem;

struct Log {
  Rig rig;
  std::vector<SensorEvent> events;
  std::vector<PoseReading> truth;
};

Log read(const fs::path& file, const std::string& pose_topic) {
  Log log;
  io::PlayOptions options;
  options.topics.imu.clear();
  options.topics.pose = pose_topic;
  const auto played = io::play(
      {file}, options, [&](const io::RecordingHeader& header) { log.rig = header.rig; },
      [&](const SensorEvent& event) {
        if (const auto* pose = std::get_if<PoseReading>(&event))
          log.truth.push_back(*pose);
        else
          log.events.push_back(event);
        return true;
      });
  if (!played) throw std::runtime_error(played.error().message());
  return log;
}

template <typename T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return std::move(result).value();
}

Trajectory tracked(const Log& log, const std::shared_ptr<const WallField>& walls) {
  SurveyTracker tracker(walls, log.rig, log.truth.front().map_T_base);
  for (const SensorEvent& event : log.events)
    std::visit(
        [&](const auto& reading) {
          if constexpr (requires { tracker.observe(reading); }) tracker.observe(reading);
        },
        event);
  return must(tracker.finish()).map_T_base;
}

/// Fingerprints of a log whose robot was at these poses.
template <typename Poses>
void collect(FingerprintCollector& collector, const Log& log, const Poses& poses) {
  std::size_t next = 0;
  for (const SensorEvent& event : log.events) {
    const auto* field = std::get_if<FieldReading>(&event);
    if (field == nullptr) continue;
    for (; next < poses.size() && poses[next].stamp <= field->stamp; ++next) collector.observe(poses[next]);
    collector.observe(*field);
  }
  if (next < poses.size()) collector.observe(poses[next]);
}

std::vector<PoseReading> readings_of(const Trajectory& trajectory) {
  std::vector<PoseReading> poses;
  for (std::size_t i = 0; i < trajectory.size(); ++i)
    poses.push_back({trajectory[i].stamp, trajectory[i].pose});
  return poses;
}

/// How far the magnetometer is from where it truly was.
struct Off {
  Eigen::Vector2d sum_m{0, 0};
  double sum_m2 = 0.0, count = 0.0;
  void add(const Log& log, const Trajectory& map_T_base) {
    const Eigen::Vector2d arm_m = log.rig.base_T_magnetometer.translation().head<2>();
    for (const PoseReading& pose : log.truth)
      if (const auto at = map_T_base.at(pose.stamp, 0.5)) {
        const Eigen::Vector2d off_m = *at * arm_m - pose.map_T_base * arm_m;
        sum_m += off_m, sum_m2 += off_m.squaredNorm(), count += 1.0;
      }
  }
  double rms_m() const { return std::sqrt(sum_m2 / count); }
  /// What all of it shares: a map of cells may lie half a cell beside the walls.
  double shift_m() const { return (sum_m / count).norm(); }
};

std::vector<fs::path> files_of(const fs::path& folder, const std::string& begin, const std::string& end) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(begin) && name.ends_with(end)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Root mean square over the axes of what a map foretells wrongly of drives, where they are told to have
/// been.
double foretold_uT(const FieldMap& map, const std::vector<Fingerprint>& drives) {
  return std::sqrt(check_field_map(map, drives).score.rms_uT.square().sum() / 3.0);
}

int main_of(const fs::path& folder) {
  const OccupancyGrid area = must(io::read_map_file(folder / "map.yaml")).grid;
  const auto walls = std::make_shared<const WallField>(area);
  std::optional<FingerprintCollector> by_truth, by_tracking, held, held_by_tracking;
  const auto begin = [](std::optional<FingerprintCollector>& collector, const Rig& rig) {
    if (collector)
      collector->start_session(rig);
    else
      collector.emplace(rig);
  };
  Off off;
  for (const fs::path& file : files_of(folder, "survey_", ".mcap")) {
    const Log log = read(file, "/ground_truth");
    const Trajectory map_T_base = tracked(log, walls);
    off.add(log, map_T_base);
    begin(by_truth, log.rig), collect(*by_truth, log, log.truth);
    begin(by_tracking, log.rig), collect(*by_tracking, log, readings_of(map_T_base));
  }
  for (const fs::path& file : files_of(folder, "run_", ".mcap")) {
    Log log = read(file, "");
    log.truth = must(io::read_truth(folder / ("truth_" + file.stem().string().substr(4) + ".csv")));
    const Trajectory map_T_base = tracked(log, walls);
    begin(held, log.rig), collect(*held, log, log.truth);
    begin(held_by_tracking, log.rig), collect(*held_by_tracking, log, readings_of(map_T_base));
  }
  if (!by_truth || !held) return fmt::print(stderr, "{}: no surveys, or no runs\n", folder.string()), 4;
  const std::vector<Fingerprint> drives = held->finish(), tracked_drives = held_by_tracking->finish();
  const FieldMap true_map = must(build_field_map(by_truth->finish(), &area)),
                 tracked_map = must(build_field_map(by_tracking->finish(), &area));
  fmt::print(
      R"({{"survey_rms_m": {}, "survey_shift_m": {}, "foretold": {}, "true_map_uT": {}, )"
      R"("tracked_map_uT": {}, "true_map_tracked_drives_uT": {}, "tracked_map_tracked_drives_uT": {}}})"
      "\n",
      off.rms_m(), off.shift_m(), drives.size(), foretold_uT(true_map, drives),
      foretold_uT(tracked_map, drives), foretold_uT(true_map, tracked_drives),
      foretold_uT(tracked_map, tracked_drives));
  return 0;
}

}  // namespace
}  // namespace mstsl

int main(int count, char** words) {
  if (count != 2) return std::fputs("usage: survey_positions FOLDER\n", stderr), 2;
  try {
    return mstsl::main_of(words[1]);
  } catch (const std::exception& error) {
    return fmt::print(stderr, "{}\n", error.what()), 4;
  }
}
