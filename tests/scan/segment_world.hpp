#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/pose2.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/grid/ray.hpp"

/// A small world of straight walls, scanned exactly: an oracle that shares no code with the matchers.
namespace mstsl::test {

struct Segment {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
};
using Segments = std::vector<Segment>;

inline Segments rectangle(double x0, double y0, double x1, double y1) {
  const Eigen::Vector2d a(x0, y0), b(x1, y0), c(x1, y1), d(x0, y1);
  return {{a, b}, {b, c}, {c, d}, {d, a}};
}

inline Segments joined(Segments a, const Segments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Two walls along x, 2.2 m apart, without an end in sight.
inline Segments bare_corridor() { return {{{-60, -1.1}, {60, -1.1}}, {{-60, 1.1}, {60, 1.1}}}; }

/// A room of 8 x 6 m with a cupboard, a pillar and a slanting wall: nothing about it is symmetric.
inline Segments room() {
  Segments walls = joined(rectangle(-4, -3, 4, 3), rectangle(-3.5, 1.7, -2.1, 2.4));
  walls = joined(walls, rectangle(1.6, -1.9, 2.0, -1.5));
  walls.push_back({{2.6, 3.0}, {4.0, 1.4}});
  return walls;
}

inline Segments moved(const Pose2& pose, Segments walls) {
  for (Segment& s : walls) s = {pose * s.a, pose * s.b};
  return walls;
}

/// Distance along a ray (unit direction) to the nearest segment.
inline std::optional<double> cast(const Segments& walls, const Eigen::Vector2d& origin,
                                  const Eigen::Vector2d& direction) {
  std::optional<double> nearest;
  for (const Segment& s : walls) {
    const Eigen::Vector2d along = s.b - s.a, to_a = s.a - origin;
    const double denominator = direction.x() * along.y() - direction.y() * along.x();
    if (std::abs(denominator) < 1e-12) continue;
    const double range = (to_a.x() * along.y() - to_a.y() * along.x()) / denominator;
    const double share = (to_a.x() * direction.y() - to_a.y() * direction.x()) / denominator;
    if (range > 0 && share >= 0 && share <= 1 && (!nearest || range < *nearest)) nearest = range;
  }
  return nearest;
}

struct LidarModel {
  int beams = 1081;
  double field_of_view_rad = radians(270);
  double range_max_m = 30.0;
  double noise_m = 0.0;
};

/// A scan from the laser at `map_T_laser`, all beams at one instant. Beams without a return are infinite.
inline LaserScan scan_of(const Segments& walls, const Pose2& map_T_laser, Random& random,
                         const LidarModel& lidar = {}) {
  LaserScan scan;
  scan.angle_min_rad = -lidar.field_of_view_rad / 2;
  scan.angle_increment_rad = lidar.field_of_view_rad / (lidar.beams - 1);
  scan.range_min_m = 0.1;
  scan.range_max_m = lidar.range_max_m;
  for (int i = 0; i < lidar.beams; ++i) {
    const double angle = map_T_laser.yaw + scan.angle_min_rad + i * scan.angle_increment_rad;
    const auto range = cast(walls, map_T_laser.position(), {std::cos(angle), std::sin(angle)});
    const double measured = range && *range < lidar.range_max_m ? *range + random.normal(0, lidar.noise_m)
                                                                : std::numeric_limits<double>::infinity();
    scan.ranges_m.push_back(static_cast<float>(measured));
  }
  return scan;
}

/// The world as a map: cells that a wall touches are occupied, all others free.
inline OccupancyGrid drawn(const Segments& walls, const GridGeometry& geometry) {
  OccupancyGrid map(geometry, CellState::kFree);
  for (const Segment& s : walls) {
    walk_cells(geometry.to_grid(s.a), geometry.to_grid(s.b), [&](Cell cell, double) {
      if (map.contains(cell)) map[cell] = CellState::kOccupied;
      return true;
    });
  }
  return map;
}

/// Cells of 5 cm over a square of the given half size, its centre and axes those of `map_T_center`.
inline GridGeometry square_around(const Pose2& map_T_center, double half_size_m, double resolution_m = 0.05) {
  const int cells = static_cast<int>(std::ceil(2 * half_size_m / resolution_m));
  return {.resolution_m = resolution_m,
          .columns = cells,
          .rows = cells,
          .map_T_grid = map_T_center * Pose2{-half_size_m, -half_size_m, 0}};
}

}  // namespace mstsl::test
