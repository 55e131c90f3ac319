#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

namespace mstsl {

/// A point in a log's time: integer nanoseconds, as in ROS messages. Differences are seconds.
struct Stamp {
  std::int64_t ns = 0;

  static constexpr Stamp from_parts(std::int64_t seconds, std::int64_t nanoseconds) {
    return {seconds * 1'000'000'000 + nanoseconds};
  }
  /// Rounded to the nearest nanosecond; expects |seconds| < 9e9.
  static Stamp from_seconds(double seconds) { return {std::llround(seconds * 1e9)}; }

  double seconds() const { return static_cast<double>(ns) * 1e-9; }

  friend constexpr auto operator<=>(const Stamp&, const Stamp&) = default;
  friend Stamp operator+(Stamp stamp, double seconds) { return {stamp.ns + std::llround(seconds * 1e9)}; }
  /// Seconds from b to a.
  friend double operator-(Stamp a, Stamp b) { return static_cast<double>(a.ns - b.ns) * 1e-9; }
};

}  // namespace mstsl
