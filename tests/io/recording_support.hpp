#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "mstsl/core/random.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/io/recording_writer.hpp"

#include "test_support.hpp"

namespace mstsl::test {

/// What a play gave.
struct Played {
  Rig rig;
  int headers = 0;
  std::vector<SensorEvent> events;
  io::PlayReport report;

  template <typename Reading>
  std::vector<Reading> of() const {
    std::vector<Reading> found;
    for (const SensorEvent& event : events)
      if (const auto* reading = std::get_if<Reading>(&event)) found.push_back(*reading);
    return found;
  }
};

inline Result<Played> try_play(const std::vector<std::filesystem::path>& files,
                               const io::PlayOptions& options = {}) {
  Played played;
  Result<io::PlayReport> report = io::play(
      files, options,
      [&](const io::RecordingHeader& header) {
        played.rig = header.rig;
        ++played.headers;
      },
      [&](const SensorEvent& event) {
        played.events.push_back(event);
        return true;
      });
  if (!report) return report.error();
  played.report = *report;
  return played;
}

inline Played play_all(const std::vector<std::filesystem::path>& files, const io::PlayOptions& options = {}) {
  return must(try_play(files, options));
}

/// A rig with full rotations.
inline Rig tilted_rig() {
  Rig rig;
  rig.base_T_laser = Eigen::Translation3d(0.3, -0.1, 0.4) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ());
  rig.base_T_magnetometer = Eigen::Translation3d(-0.2, 0.05, 0.9) *
                            Eigen::AngleAxisd(2.5, Eigen::Vector3d(1.0, 2.0, -0.5).normalized());
  return rig;
}

/// A drive of `seconds`: odometry and field at 50 Hz, IMU and pose at 25 Hz, scans of `beams` at 10 Hz, each
/// kind with stamps of its own, from `start_s` on.
inline std::vector<SensorEvent> random_drive(Random& random, double seconds, std::size_t beams = 31,
                                             double start_s = 1'700'000'000.0) {
  std::vector<SensorEvent> events;
  Pose2 pose;
  for (int i = 0; i < static_cast<int>(seconds * 50.0); ++i) {
    const Stamp stamp = Stamp::from_seconds(start_s) + 0.02 * i;
    pose = pose * Pose2{0.02 * random.uniform(), 0.0, random.normal(0.0, 0.05)};
    events.push_back(OdometryReading{stamp, pose});
    events.push_back(
        FieldReading{{stamp.ns + 1'000'000},
                     {random.normal(20.0, 5.0), random.normal(0.0, 5.0), random.normal(-40.0, 5.0)}});
    if (i % 2 == 0) {
      ImuReading imu{
          {stamp.ns + 2'000'000}, {random.normal(), random.normal(), random.normal()}, std::nullopt};
      if (random.chance(0.5))
        imu.world_q_sensor = Eigen::AngleAxisd(random.normal(), Eigen::Vector3d::UnitY());
      events.push_back(imu);
      events.push_back(
          PoseReading{{stamp.ns + 3'000'000}, {random.normal(), random.normal(), random.uniform(-3.1, 3.1)}});
    }
    if (i % 5 == 0) {
      LaserScan scan{{stamp.ns + 4'000'000}, -1.5, 0.0625, 0.0, 0.125, 30.0, {}};
      for (std::size_t beam = 0; beam < beams; ++beam)
        scan.ranges_m.push_back(static_cast<float>(random.uniform(0.2, 29.0)));
      events.push_back(scan);
    }
  }
  return events;
}

inline io::Topics survey_topics() {
  io::Topics topics;
  topics.pose = "/ground_truth";
  return topics;
}

inline void write_log(const std::filesystem::path& file, const std::vector<SensorEvent>& events,
                      const io::Topics& topics = {}, const Rig& rig = tilted_rig()) {
  io::RecordingWriter writer = must(io::RecordingWriter::open(file, rig, topics));
  for (const SensorEvent& event : events) must(writer.write(event));
  must(writer.close());
}

inline std::string read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_bytes(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// To compare times exactly, as they are in a log.
inline std::vector<std::int64_t> nanoseconds(const std::vector<double>& seconds) {
  std::vector<std::int64_t> all;
  for (const double second : seconds) all.push_back(Stamp::from_seconds(second).ns);
  return all;
}

/// How often a problem was counted whose words contain `words`.
inline std::uint64_t problems(const io::PlayReport& report, std::string_view words) {
  std::uint64_t count = 0;
  for (const auto& [problem, times] : report.problems)
    if (problem.find(words) != std::string::npos) count += times;
  return count;
}

inline bool warns_of(const io::PlayReport& report, std::string_view words) {
  for (const std::string& warning : report.warnings)
    if (warning.find(words) != std::string::npos) return true;
  return false;
}

}  // namespace mstsl::test
