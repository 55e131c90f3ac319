#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "mstsl/core/magnetometer_calibration.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"

namespace mstsl::io {

/// Which topics carry what. An empty name means: not wanted (its messages are not even decoded).
struct Topics {
  std::string scan = "/scan";
  std::string magnetic_field = "/imu/mag";
  std::string odometry = "/odom";
  std::string transforms_static = "/tf_static";
  std::string imu = "/imu/data";
  std::string pose;  ///< Odometry, PoseStamped or PoseWithCovarianceStamped; only surveys have one
};

struct PlayOptions {
  Topics topics;
  std::string base_frame = "base_link";
  double reorder_window_s =
      1.0;  ///< events this late are put back into order; later ones are dropped and counted
  MagnetometerCalibration calibration;  ///< undone in every field reading
};

/// What was wrong with a log that could still be used, by kind ("late messages dropped" -> 12), and what it
/// held.
struct PlayReport {
  std::map<std::string, std::uint64_t> messages;  ///< per topic
  std::map<std::string, std::uint64_t> problems;
  std::vector<std::string> warnings;  ///< one clear sentence each, ready for stderr
};

/// What a log says about the robot before its first event.
struct RecordingHeader {
  Rig rig;
};

/// Plays recordings (MCAP file or rosbag2 folder, ROS 1 bag, CARMEN log; several are one after the other) as
/// sensor events in time order, in SI units and microtesla. Reads piece by piece: memory does not grow with
/// the log. `on_header` is called once, before the first event; returning false from `on_event` stops the
/// play early. Errors: a file that cannot be read at all, or lacks a topic that was asked for (the message
/// lists those there). A log that ends in the middle is played to its last whole message and reported.
Result<PlayReport> play(const std::vector<std::filesystem::path>& files, const PlayOptions& options,
                        const std::function<void(const RecordingHeader&)>& on_header,
                        const std::function<bool(const SensorEvent&)>& on_event);

}  // namespace mstsl::io
