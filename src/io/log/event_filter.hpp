#pragma once

#include <array>
#include <functional>
#include <optional>
#include <variant>

#include "mstsl/core/sensor_data.hpp"
#include "mstsl/io/recording.hpp"

namespace mstsl::io {

/// Looks at events that are in time order: drops a second one of a sensor with the same stamp, and puts a
/// restart before an odometry reading that no robot can have driven to.
class EventFilter {
 public:
  using Deliver = std::function<bool(const SensorEvent&)>;

  EventFilter(PlayReport& report, const Deliver& deliver) : report_(&report), deliver_(&deliver) {}

  bool push(const SensorEvent& event);

 private:
  bool is_duplicate(const SensorEvent& event);
  bool restarts_odometry(const SensorEvent& event);

  PlayReport* report_;
  const Deliver* deliver_;
  std::array<std::optional<Stamp>, std::variant_size_v<SensorEvent>> last_;  ///< by kind of event
  std::optional<OdometryReading> last_odometry_;
};

}  // namespace mstsl::io
