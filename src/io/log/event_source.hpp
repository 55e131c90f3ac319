#pragma once

#include <functional>
#include <memory>
#include <string>

#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/io/recording.hpp"

#include "io/log/message_log.hpp"

namespace mstsl::io {

/// A recording whose sensors are known and whose events can be read.
class EventSource {
 public:
  /// Takes an event and the time at which it was recorded; false: enough.
  using Take = std::function<bool(Stamp log_time, SensorEvent event)>;

  virtual ~EventSource() = default;
  virtual const std::string& name() const = 0;
  virtual const Rig& rig() const = 0;
  /// Gives the events in the order of the log. Damage and unusable messages are noted in the report.
  virtual void read(const Take& take, PlayReport& report) = 0;
};

/// Looks ahead into a log of ROS messages for frames, mountings and the unit of the magnetic readings; what
/// had to be assumed becomes a warning. Errors: a topic is missing, or the magnetic readings fit no unit.
Result<std::unique_ptr<EventSource>> open_ros_source(std::string name, std::unique_ptr<MessageLog> log,
                                                     const PlayOptions& options, PlayReport& report);

}  // namespace mstsl::io
