#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mstsl/core/sensor_data.hpp"
#include "mstsl/io/recording.hpp"

namespace mstsl::io {

/// Puts events that come nearly in the order of their stamps into that order, and copes with clocks that
/// jump.
///
/// An event is held back until one comes that is more than the window newer. One that is older than what was
/// already given on is late, and dropped. But where the clock was set, everything is "late" (or far ahead)
/// from then on: a stamp that is out of the running time is believed when the time of recording jumped with
/// it, or when a whole row of events agrees with it.
class EventOrder {
 public:
  using Deliver = std::function<bool(const SensorEvent&)>;

  EventOrder(double window_s, std::string log_name, PlayReport& report, Deliver deliver);

  /// False when the receiver wants no more.
  bool push(Stamp log_time, SensorEvent event);
  /// Gives on what is held back.
  bool finish();

 private:
  struct Pending {
    Stamp stamp;
    std::uint64_t sequence;
    SensorEvent event;
  };
  enum class Course { kOnTime, kLate, kAhead };

  static bool is_later(const Pending& a, const Pending& b);
  Course course_of(Stamp stamp) const;
  bool is_believable(Course course, Stamp log_time);
  bool jump(Course course, Stamp to);
  bool release_until(std::optional<Stamp> limit);

  double window_s_;
  std::string log_name_;
  PlayReport* report_;
  Deliver deliver_;
  std::vector<Pending> heap_;
  std::uint64_t sequence_ = 0;
  std::optional<Stamp> newest_, newest_log_time_, released_;
  Course last_course_ = Course::kOnTime;
  int in_a_row_ = 0;  ///< events just before this one that were out of time in the same direction
  int jumps_ = 0;
  bool restarts_ = false;  ///< the clock ran back, and no event was given on since
  bool stopped_ = false;
};

}  // namespace mstsl::io
