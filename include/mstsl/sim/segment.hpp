#pragma once

#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"

namespace mstsl::sim {

/// A straight piece of wall seen from above, from a to b in m.
struct Segment {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
};

double length(const Segment& segment);

/// The third component of the cross product: twice the signed area between two vectors.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The point at a share (0 at a, 1 at b) of the way along.
Eigen::Vector2d point_along(const Segment& segment, double fraction);

/// Shortest distance from a point to any point of the segment, m.
double distance(const Eigen::Vector2d& point_m, const Segment& segment);

/// Whether two segments share a point.
bool intersect(const Segment& first, const Segment& second);

Segment operator*(const Pose2& a_T_b, const Segment& segment_b);

/// The outline of a box with its middle at the pose; size along the pose's x and y, m.
std::vector<Segment> box(const Pose2& map_T_middle, const Eigen::Vector2d& size_m);

/// The pieces of a line through the points; closed back to the first if asked.
std::vector<Segment> polyline(const std::vector<Eigen::Vector2d>& points_m, bool closed);

}  // namespace mstsl::sim
