#pragma once

#include <cmath>
#include <numbers>

namespace mstsl {

inline constexpr double kPi = std::numbers::pi;

constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

/// The same direction in (-pi, pi]. Expects a finite angle in rad.
inline double wrap_angle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

/// The shortest turn from `from_rad` to `to_rad`, in (-pi, pi].
inline double angle_between(double from_rad, double to_rad) { return wrap_angle(to_rad - from_rad); }

}  // namespace mstsl
