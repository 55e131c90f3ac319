#include "mstsl/scan/scanned_walls.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace mstsl {
namespace {

/// The direction in which the points lie least spread; nothing for fewer than three or for a cluster.
bool normal_of(const std::vector<BeamReturn>& returns, std::size_t first, std::size_t last,
               Eigen::Vector2d& normal) {
  const auto n = static_cast<double>(last - first);
  if (n < 3) return false;
  Eigen::Vector2d mean(0, 0);
  for (std::size_t i = first; i < last; ++i) mean += returns[i].point_m / n;
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = first; i < last; ++i) {
    const Eigen::Vector2d d = returns[i].point_m - mean;
    xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y();
  }
  const double along_rad = 0.5 * std::atan2(2 * xy, xx - yy);
  normal = {-std::sin(along_rad), std::cos(along_rad)};
  const double across =
      normal.x() * normal.x() * xx + 2 * normal.x() * normal.y() * xy + normal.y() * normal.y() * yy;
  constexpr double kFlat = 0.3;  // of the spread along the wall: more is no line
  return across < kFlat * kFlat * (xx + yy - across);
}

GridGeometry square(const Eigen::Vector2d& center_m, const ScannedWallsOptions& options) {
  const int cells = 2 * static_cast<int>(std::ceil(options.half_size_m / options.cell_m));
  const Eigen::Vector2d corner_m = center_m.array() - 0.5 * cells * options.cell_m;
  return {.resolution_m = options.cell_m,
          .columns = cells,
          .rows = cells,
          .map_T_grid = {corner_m.x(), corner_m.y(), 0}};
}

}  // namespace

std::vector<FacedPoint> faced_points(const std::vector<BeamReturn>& returns, double max_gap_m) {
  // Three neighbours to each side, and near the laser, where beams lie closer than their noise, all within
  // 0.2 m: a shorter piece of wall faces anywhere.
  constexpr std::size_t kToEachSide = 3, kMost = 30;
  constexpr double kHalf_m = 0.2;
  std::vector<FacedPoint> faced;
  if (returns.size() < 3) return faced;
  const auto joined = [&](std::size_t a, std::size_t b) {
    const double gap_m = (returns[a].point_m - returns[b].point_m).norm();
    const Eigen::Vector2d u = returns[a].point_m - returns[a].origin_m,
                          v = returns[b].point_m - returns[b].origin_m;
    const double spread_m = std::abs(u.x() * v.y() - u.y() * v.x()) / std::max(u.norm(), 1e-6);
    return gap_m <= std::max(max_gap_m, 3.0 * spread_m);
  };
  std::vector<bool> to_next(returns.size(), false);
  for (std::size_t i = 0; i + 1 < returns.size(); ++i) to_next[i] = joined(i, i + 1);
  for (std::size_t i = 0; i < returns.size(); ++i) {
    std::size_t first = i, last = i;
    const auto near = [&](std::size_t k, std::size_t apart) {
      return apart <= kToEachSide ||
             (apart <= kMost && (returns[k].point_m - returns[i].point_m).norm() < kHalf_m);
    };
    while (first > 0 && to_next[first - 1] && near(first - 1, i - first + 1)) --first;
    while (last + 1 < returns.size() && to_next[last] && near(last + 1, last + 1 - i)) ++last;
    FacedPoint point{returns[i].point_m, {0, 0}};
    if (normal_of(returns, first, last + 1, point.normal)) faced.push_back(point);
  }
  return faced;
}

PointSet places_of(const std::vector<FacedPoint>& points) {
  PointSet places;
  places.reserve(points.size());
  for (const FacedPoint& p : points) places.push_back(p.point_m);
  return places;
}

ScannedWalls::ScannedWalls(const Eigen::Vector2d& center_m, const ScannedWallsOptions& options)
    : center_m_(center_m),
      options_(options),
      piece_in_(square(center_m, options), -1),
      nearest_(piece_in_.geometry(), -1) {}

void ScannedWalls::add(const std::vector<FacedPoint>& points_base_m, const Pose2& map_T_base) {
  const Eigen::Matrix2d rotation = map_T_base.rotation();
  for (const FacedPoint& p : points_base_m) {
    const Eigen::Vector2d at_m = rotation * p.point_m + map_T_base.position();
    const Cell cell = piece_in_.geometry().cell_at(at_m);
    if (!piece_in_.contains(cell)) continue;
    std::int32_t& index = piece_in_[cell];
    const bool is_new = index < 0;
    if (is_new) {
      index = static_cast<std::int32_t>(pieces_.size());
      pieces_.emplace_back();
    }
    Piece& piece = pieces_[static_cast<std::size_t>(index)];
    const Eigen::Vector2d n = rotation * p.normal;
    piece.sum_m += at_m;
    piece.facing += Eigen::Vector3d(n.x() * n.x(), n.x() * n.y(), n.y() * n.y());
    piece.count += 1.0;
    if (is_new) spread(index);
  }
}

void ScannedWalls::spread(std::int32_t piece) {
  const GridGeometry& g = nearest_.geometry();
  const Eigen::Vector2d mean_m = pieces_[static_cast<std::size_t>(piece)].mean_m();
  const Cell middle = g.cell_at(mean_m);
  const int cells = static_cast<int>(std::ceil(options_.reach_m / options_.cell_m));
  for (int row = middle.row - cells; row <= middle.row + cells; ++row)
    for (int column = middle.column - cells; column <= middle.column + cells; ++column) {
      const Cell cell{column, row};
      if (!nearest_.contains(cell)) continue;
      const Eigen::Vector2d center_m = g.center_of(cell);
      std::int32_t& nearest = nearest_[cell];
      if (nearest < 0 || (center_m - mean_m).squaredNorm() <
                             (center_m - pieces_[static_cast<std::size_t>(nearest)].mean_m()).squaredNorm())
        nearest = piece;
    }
}

WallSample ScannedWalls::sample(const Eigen::Vector2d& map_point_m) const {
  const WallSample none{options_.reach_m * options_.reach_m};
  const Cell cell = nearest_.geometry().cell_at(map_point_m);
  if (!nearest_.contains(cell) || nearest_[cell] < 0) return none;
  const Piece& piece = pieces_[static_cast<std::size_t>(nearest_[cell])];
  const Eigen::Vector2d d = map_point_m - piece.mean_m();
  const Eigen::Vector3d facing = piece.facing / piece.count;
  const Eigen::Vector2d slope(facing.x() * d.x() + facing.y() * d.y(),
                              facing.y() * d.x() + facing.z() * d.y());
  // The larger eigenvalue: 1 for a plain wall, a half for a corner, which is a point.
  const double half = 0.5 * (facing.x() - facing.z());
  const double main = 0.5 + std::sqrt(half * half + facing.y() * facing.y());
  const double across = d.dot(slope) / main;
  const double beside = std::max(0.0, std::sqrt(std::max(0.0, d.squaredNorm() - across)) - options_.cell_m);
  const double squared = across + beside * beside;
  if (squared >= none.squared_m2) return none;
  return {squared, slope, facing};
}

}  // namespace mstsl
