#include "io/log/event_filter.hpp"

#include <utility>

namespace mstsl::io {
namespace {

/// Indoor robots drive 1 to 3 m/s; wheel odometry that moves further than a metre faster than this was reset.
constexpr double kImpossibleSpeed_m_s = 10.0;
constexpr double kJump_m = 1.0;

}  // namespace

bool EventFilter::push(const SensorEvent& event) {
  if (std::holds_alternative<OdometryRestart>(event)) {
    last_ = {};
    last_odometry_.reset();
    return (*deliver_)(event);
  }
  if (is_duplicate(event)) {
    ++report_->problems["messages with the stamp of the one before dropped"];
    return true;
  }
  if (restarts_odometry(event)) {
    ++report_->problems["jumps of the odometry, taken as restarts"];
    if (!(*deliver_)(OdometryRestart{stamp_of(event)})) return false;
  }
  return (*deliver_)(event);
}

bool EventFilter::is_duplicate(const SensorEvent& event) {
  std::optional<Stamp>& last = last_[event.index()];
  const bool same = last == stamp_of(event);
  last = stamp_of(event);
  return same;
}

bool EventFilter::restarts_odometry(const SensorEvent& event) {
  const auto* reading = std::get_if<OdometryReading>(&event);
  if (reading == nullptr) return false;
  const std::optional<OdometryReading> last = std::exchange(last_odometry_, *reading);
  if (!last) return false;
  const double moved_m = distance(last->odom_T_base, reading->odom_T_base);
  return moved_m > kJump_m && moved_m > kImpossibleSpeed_m_s * (reading->stamp - last->stamp);
}

}  // namespace mstsl::io
