#include "io/log/event_order.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace mstsl::io {
namespace {

/// No sensor used here is silent so long while a log is recorded.
constexpr double kLongestSilence_s = 10.0;

/// So many events out of time without one in time between them are a clock that was set, not a hiccup of the
/// network: about half a second of a robot's sensors together.
constexpr int kRowThatConvinces = 100;

/// Far more than the sensors of a robot give within any sensible window; bounds the memory for hostile
/// stamps.
constexpr std::size_t kMostPending = 20'000;

/// Jumps that get a sentence of their own; a clock that never stops jumping is only counted.
constexpr int kMostTold = 5;

}  // namespace

EventOrder::EventOrder(double window_s, std::string log_name, PlayReport& report, Deliver deliver)
    : window_s_(window_s), log_name_(std::move(log_name)), report_(&report), deliver_(std::move(deliver)) {}

bool EventOrder::push(Stamp log_time, SensorEvent event) {
  const Stamp stamp = stamp_of(event);
  const Course course = course_of(stamp);
  if (course != Course::kOnTime) {
    if (!is_believable(course, log_time)) {
      ++report_->problems[course == Course::kLate ? "late messages dropped"
                                                  : "stamps far in the future dropped"];
      return true;
    }
    if (!jump(course, stamp)) return false;
  }
  last_course_ = Course::kOnTime;
  in_a_row_ = 0;
  newest_ = newest_ ? std::max(*newest_, stamp) : stamp;
  newest_log_time_ = log_time;
  heap_.push_back({stamp, sequence_++, std::move(event)});
  std::ranges::push_heap(heap_, &is_later);
  return release_until(*newest_ + -window_s_);
}

bool EventOrder::finish() { return release_until(std::nullopt); }

bool EventOrder::is_later(const Pending& a, const Pending& b) {
  return std::tie(a.stamp, a.sequence) > std::tie(b.stamp, b.sequence);
}

EventOrder::Course EventOrder::course_of(Stamp stamp) const {
  if (released_ && stamp < *released_) return Course::kLate;
  if (newest_ && stamp - *newest_ > kLongestSilence_s) return Course::kAhead;
  return Course::kOnTime;
}

bool EventOrder::is_believable(Course course, Stamp log_time) {
  in_a_row_ = course == last_course_ ? in_a_row_ + 1 : 1;
  last_course_ = course;
  const double recorded_s = log_time - *newest_log_time_;
  const bool recorder_agrees =
      course == Course::kLate ? recorded_s < -window_s_ : recorded_s > kLongestSilence_s;
  return recorder_agrees || in_a_row_ >= kRowThatConvinces;
}

bool EventOrder::jump(Course course, Stamp to) {
  const bool back = course == Course::kLate;
  ++report_->problems[back ? "clock jumps back" : "clock jumps forward"];
  if (jumps_++ < kMostTold)
    report_->warnings.push_back(
        fmt::format("{}: the clock jumps {} by {:.1f} s at {:.3f} s; going on from there", log_name_,
                    back ? "back" : "forward", std::abs(to - *newest_), newest_->seconds()));
  if (!release_until(std::nullopt)) return false;
  newest_.reset();
  if (back) released_.reset();
  restarts_ = restarts_ || back;
  return true;
}

bool EventOrder::release_until(std::optional<Stamp> limit) {
  while (!stopped_ && !heap_.empty() &&
         (!limit || heap_.front().stamp < *limit || heap_.size() > kMostPending)) {
    std::ranges::pop_heap(heap_, &is_later);
    const Pending next = std::move(heap_.back());
    heap_.pop_back();
    released_ = next.stamp;
    // Nobody who adds up motion over time can do so across a clock that runs back.
    if (std::exchange(restarts_, false)) stopped_ = !deliver_(OdometryRestart{next.stamp});
    if (!stopped_) stopped_ = !deliver_(next.event);
  }
  return !stopped_;
}

}  // namespace mstsl::io
