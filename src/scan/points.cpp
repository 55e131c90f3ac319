#include "mstsl/scan/points.hpp"

#include <cmath>
#include <cstdint>

namespace mstsl {
namespace {

bool is_return(const LaserScan& scan, double range_m) {
  return std::isfinite(range_m) && range_m >= scan.range_min_m && range_m <= scan.range_max_m;
}

/// The points kept so far, found by place: each bucket is a chain through `next_`. Buckets are shared by
/// chance by cells far apart, which costs a look but no mistake, since the distance decides.
class NeighbourTable {
 public:
  NeighbourTable(std::size_t capacity, double spacing_m) : spacing_m_(spacing_m) {
    std::size_t buckets = 16;
    while (buckets < 2 * capacity) buckets *= 2;
    heads_.assign(buckets, -1);
  }

  bool has_nearer(const PointSet& kept, const Eigen::Vector2d& point) const {
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int i = heads_[bucket(point, dx, dy)]; i >= 0; i = next_[i]) {
          if ((kept[i] - point).squaredNorm() < spacing_m_ * spacing_m_) return true;
        }
      }
    }
    return false;
  }

  /// Expects points in the order in which they are kept: 0, 1, 2...
  void add(const Eigen::Vector2d& point) {
    int& head = heads_[bucket(point, 0, 0)];
    next_.push_back(head);
    head = static_cast<int>(next_.size()) - 1;
  }

 private:
  std::size_t bucket(const Eigen::Vector2d& point, int dx, int dy) const {
    // Unsigned, so that a point at the end of the world wraps round and stays defined.
    const std::uint64_t x = static_cast<std::uint64_t>(std::llround(std::floor(point.x() / spacing_m_))) + dx;
    const std::uint64_t y = static_cast<std::uint64_t>(std::llround(std::floor(point.y() / spacing_m_))) + dy;
    const std::uint64_t mixed = (x * 0x9E3779B97F4A7C15ULL) ^ (y * 0xC2B2AE3D27D4EB4FULL);
    return static_cast<std::size_t>(mixed ^ (mixed >> 29)) & (heads_.size() - 1);
  }

  double spacing_m_;
  std::vector<int> heads_;
  std::vector<int> next_;
};

}  // namespace

double sweep_duration_s(const LaserScan& scan) {
  return scan.ranges_m.empty() ? 0.0 : scan.time_increment_s * static_cast<double>(scan.ranges_m.size() - 1);
}

std::vector<BeamReturn> beam_returns(const LaserScan& scan, const Eigen::Isometry3d& base_T_laser,
                                     const Pose2& first_T_last) {
  const Eigen::Matrix2d base_R_laser = base_T_laser.linear().topLeftCorner<2, 2>();
  const Eigen::Vector2d laser_m = base_T_laser.translation().head<2>();
  const bool moves = first_T_last.x != 0.0 || first_T_last.y != 0.0 || first_T_last.yaw != 0.0;
  const double last = static_cast<double>(scan.ranges_m.size()) - 1.0;

  std::vector<BeamReturn> returns;
  returns.reserve(scan.ranges_m.size());
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double range_m = scan.ranges_m[i];
    if (!is_return(scan, range_m)) continue;
    const double angle = scan.angle_min_rad + static_cast<double>(i) * scan.angle_increment_rad;
    const Eigen::Vector2d beam_m = range_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    BeamReturn found{laser_m, base_R_laser * beam_m + laser_m};
    if (moves && last > 0) {
      const Pose2 first_T_now = interpolate(Pose2{}, first_T_last, static_cast<double>(i) / last);
      found = {first_T_now * found.origin_m, first_T_now * found.point_m};
    }
    if (found.point_m.allFinite() && found.origin_m.allFinite()) returns.push_back(found);
  }
  return returns;
}

PointSet end_points(const std::vector<BeamReturn>& returns) {
  PointSet points;
  points.reserve(returns.size());
  for (const BeamReturn& r : returns) points.push_back(r.point_m);
  return points;
}

PointSet points_in_base(const LaserScan& scan, const Eigen::Isometry3d& base_T_laser,
                        const Pose2& first_T_last) {
  return end_points(beam_returns(scan, base_T_laser, first_T_last));
}

PointSet transformed(const Pose2& a_T_b, const PointSet& points_b) {
  const Eigen::Matrix2d rotation = a_T_b.rotation();
  PointSet points_a;
  points_a.reserve(points_b.size());
  for (const Eigen::Vector2d& p : points_b) points_a.push_back(rotation * p + a_T_b.position());
  return points_a;
}

PointSet thinned(const PointSet& points, double spacing_m) {
  if (!(spacing_m > 0)) return points;
  NeighbourTable table(points.size(), spacing_m);
  PointSet kept;
  for (const Eigen::Vector2d& point : points) {
    if (table.has_nearer(kept, point)) continue;
    table.add(point);
    kept.push_back(point);
  }
  return kept;
}

PointSet at_most(const PointSet& points, std::size_t count) {
  if (points.size() <= count) return points;
  PointSet kept;
  kept.reserve(count);
  for (std::size_t i = 0; i < count; ++i) kept.push_back(points[i * points.size() / count]);
  return kept;
}

}  // namespace mstsl
