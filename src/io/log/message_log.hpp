#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/core/stamp.hpp"
#include "mstsl/io/recording.hpp"

#include "io/bytes.hpp"
#include "io/ros/decode.hpp"

namespace mstsl::io {

/// One stream of messages in a log.
struct Channel {
  std::string topic;
  std::string type;  ///< package/Name, as ROS 1 writes it
  ros::Encoding encoding = ros::Encoding::kOther;
  std::uint64_t message_count = 0;
};

/// A message as it lies in the log.
struct RawMessage {
  const Channel* channel;
  Stamp log_time;  ///< when it was recorded
  ByteView data;   ///< valid during the visit only
};

/// A log of ROS messages: an MCAP file, a rosbag2 folder, or a ROS 1 bag.
class MessageLog {
 public:
  using Wanted = std::function<bool(const Channel&)>;
  using Visit = std::function<bool(const RawMessage&)>;

  virtual ~MessageLog() = default;

  /// All channels of the log, from its index or, where it has none, from a pass over it.
  virtual const std::vector<Channel>& channels() const = 0;

  struct TimeSpan {
    Stamp first, last;
  };
  /// The log times of the first and last message; nothing when there is none.
  virtual std::optional<TimeSpan> time_span() const = 0;

  /// Visits the messages of the wanted channels in the order of the log until `visit` gives false. Damage is
  /// passed over and noted in `report`. Without a report this is a look ahead: the index is used to read as
  /// little as possible, and check sums of the whole file are left out.
  virtual void read(const Wanted& wanted, const Visit& visit, PlayReport* report) = 0;
};

}  // namespace mstsl::io
