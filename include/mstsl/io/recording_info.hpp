#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/core/stamp.hpp"

namespace mstsl::io {

struct TopicInfo {
  std::string name;
  std::string type;  ///< "sensor_msgs/LaserScan"; of a CARMEN log the words that begin its lines
  std::uint64_t messages = 0;
};

/// What a recording holds, without playing it.
struct RecordingInfo {
  std::string format;             ///< "MCAP", "rosbag2 folder", "ROS 1 bag" or "CARMEN log"
  std::vector<TopicInfo> topics;  ///< by name
  std::optional<Stamp> first;     ///< when its first message was recorded; nothing in an empty recording
  std::optional<Stamp> last;
};

/// Whether play() would know what to do with the file or folder, by its content.
bool is_recording(const std::filesystem::path& path);

/// From the recording's index where it has one, else by a pass over it. Errors: it cannot be read.
Result<RecordingInfo> describe_recording(const std::filesystem::path& path);

}  // namespace mstsl::io
