#include "mstsl/sim/segment.hpp"

#include <algorithm>
#include <cstddef>

namespace mstsl::sim {
namespace {

/// Which side of the segment's line a point lies on: the sign of this.
double side(const Segment& segment, const Eigen::Vector2d& point_m) {
  return cross(segment.b - segment.a, point_m - segment.a);
}

bool boxes_meet(const Segment& p, const Segment& q) {
  const auto meet = [&](int axis) {
    return std::max(std::min(p.a[axis], p.b[axis]), std::min(q.a[axis], q.b[axis])) <=
           std::min(std::max(p.a[axis], p.b[axis]), std::max(q.a[axis], q.b[axis]));
  };
  return meet(0) && meet(1);
}

}  // namespace

double length(const Segment& segment) { return (segment.b - segment.a).norm(); }

Eigen::Vector2d point_along(const Segment& segment, double fraction) {
  return segment.a + fraction * (segment.b - segment.a);
}

double distance(const Eigen::Vector2d& point_m, const Segment& segment) {
  const Eigen::Vector2d along = segment.b - segment.a;
  const double squared = along.squaredNorm();
  const double fraction =
      squared > 0 ? std::clamp((point_m - segment.a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (point_m - point_along(segment, fraction)).norm();
}

bool intersect(const Segment& first, const Segment& second) {
  return boxes_meet(first, second) && side(first, second.a) * side(first, second.b) <= 0 &&
         side(second, first.a) * side(second, first.b) <= 0;
}

Segment operator*(const Pose2& a_T_b, const Segment& segment_b) {
  return {a_T_b * segment_b.a, a_T_b * segment_b.b};
}

std::vector<Segment> box(const Pose2& map_T_middle, const Eigen::Vector2d& size_m) {
  const Eigen::Vector2d half = 0.5 * size_m;
  return polyline({map_T_middle * Eigen::Vector2d(-half.x(), -half.y()),
                   map_T_middle * Eigen::Vector2d(half.x(), -half.y()),
                   map_T_middle * Eigen::Vector2d(half.x(), half.y()),
                   map_T_middle * Eigen::Vector2d(-half.x(), half.y())},
                  true);
}

std::vector<Segment> polyline(const std::vector<Eigen::Vector2d>& points_m, bool closed) {
  std::vector<Segment> pieces;
  for (std::size_t i = 1; i < points_m.size(); ++i) pieces.push_back({points_m[i - 1], points_m[i]});
  if (closed && points_m.size() > 2) pieces.push_back({points_m.back(), points_m.front()});
  return pieces;
}

}  // namespace mstsl::sim
