#include "mstsl/sim/route.hpp"

#include <cstddef>

namespace mstsl::sim {

double length(const Route& route) {
  double sum = 0.0;
  for (std::size_t i = 1; i < route.waypoints_m.size(); ++i)
    sum += (route.waypoints_m[i] - route.waypoints_m[i - 1]).norm();
  return sum;
}

Route truncated(const Route& route, double length_m) {
  Route part{route.start_yaw_rad, {}};
  double left_m = length_m;
  for (const Eigen::Vector2d& point : route.waypoints_m) {
    if (part.waypoints_m.empty()) {
      part.waypoints_m.push_back(point);
      continue;
    }
    const Eigen::Vector2d from = part.waypoints_m.back();
    const double step_m = (point - from).norm();
    if (step_m >= left_m) {
      if (left_m > 0) part.waypoints_m.push_back(from + (point - from) * (left_m / step_m));
      break;
    }
    part.waypoints_m.push_back(point);
    left_m -= step_m;
  }
  return part;
}

}  // namespace mstsl::sim
