#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>

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
  /// Ends at the first or last stamp there is rather than wrap around; expects |seconds| < 9e9.
  friend Stamp operator+(Stamp stamp, double seconds) {
    constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min(),
                           kLast = std::numeric_limits<std::int64_t>::max();
    const std::int64_t added = std::llround(seconds * 1e9);
    if (added > 0 && stamp.ns > kLast - added) return {kLast};
    if (added < 0 && stamp.ns < kFirst - added) return {kFirst};
    return {stamp.ns + added};
  }
  /// Seconds from b to a, for any two stamps: damaged logs hold the most distant ones.
  friend double operator-(Stamp a, Stamp b) {
    const auto gap = [](Stamp late, Stamp early) {
      return static_cast<double>(static_cast<std::uint64_t>(late.ns) - static_cast<std::uint64_t>(early.ns)) *
             1e-9;
    };
    return a >= b ? gap(a, b) : -gap(b, a);
  }
};

}  // namespace mstsl
