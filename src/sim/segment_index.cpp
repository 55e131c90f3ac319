#include "mstsl/sim/segment_index.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace mstsl::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Segments are also entered in buckets they miss by this little, so that rounding loses none.
constexpr double kSlack_m = 1e-9;

/// The distance along the ray to a segment, or infinity.
double meet(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction, const Segment& segment) {
  const Eigen::Vector2d edge = segment.b - segment.a;
  const double denominator = cross(direction, edge);
  if (denominator == 0.0) return kInfinity;
  const Eigen::Vector2d to_a = segment.a - origin_m;
  const double range = cross(to_a, edge) / denominator;
  const double share = cross(to_a, direction) / denominator;
  return range >= 0.0 && share >= 0.0 && share <= 1.0 ? range : kInfinity;
}

/// Whether a segment whose bounding box already meets a square also crosses it: all corners on one side means
/// no.
bool touches_square(const Segment& segment, const Eigen::Vector2d& middle_m, double half_m) {
  const Eigen::Vector2d edge = segment.b - segment.a;
  const double reach = half_m * (std::abs(edge.x()) + std::abs(edge.y()));
  return std::abs(cross(edge, middle_m - segment.a)) <= reach;
}

/// Walks the buckets that a ray passes, in order (Amanatides & Woo 1987).
struct Walk {
  int column, row;
  int step_column, step_row;
  double next_x_m, next_y_m;  ///< range at which the ray enters the next column, row
  double per_column_m, per_row_m;

  void advance() {
    if (next_x_m < next_y_m) {
      column += step_column;
      next_x_m += per_column_m;
    } else {
      row += step_row;
      next_y_m += per_row_m;
    }
  }
  double leaves_at_m() const { return std::min(next_x_m, next_y_m); }
};

struct AxisWalk {
  int step;
  double next_m, per_bucket_m;
};

AxisWalk walk_axis(double position_buckets, int bucket, double direction, double bucket_m) {
  if (direction == 0.0) return {0, kInfinity, kInfinity};
  const double to_edge = direction > 0 ? bucket + 1 - position_buckets : position_buckets - bucket;
  return {direction > 0 ? 1 : -1, to_edge * bucket_m / std::abs(direction), bucket_m / std::abs(direction)};
}

}  // namespace

SegmentIndex::SegmentIndex(std::vector<Segment> segments, double bucket_m)
    : segments_(std::move(segments)), bucket_m_(bucket_m) {
  assert(bucket_m > 0);
  if (segments_.empty()) return;
  Eigen::Vector2d low = segments_.front().a, high = low;
  for (const Segment& s : segments_) {
    low = low.cwiseMin(s.a).cwiseMin(s.b);
    high = high.cwiseMax(s.a).cwiseMax(s.b);
  }
  corner_m_ = low.array() - 0.5 * bucket_m_;
  columns_ = static_cast<int>((high.x() - corner_m_.x()) / bucket_m_) + 1;
  rows_ = static_cast<int>((high.y() - corner_m_.y()) / bucket_m_) + 1;

  std::vector<std::vector<std::uint32_t>> lists(static_cast<std::size_t>(columns_) *
                                                static_cast<std::size_t>(rows_));
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& s = segments_[i];
    const Eigen::Vector2d from = (s.a.cwiseMin(s.b) - corner_m_).array() - kSlack_m;
    const Eigen::Vector2d to = (s.a.cwiseMax(s.b) - corner_m_).array() + kSlack_m;
    for (int row = static_cast<int>(from.y() / bucket_m_); row <= static_cast<int>(to.y() / bucket_m_); ++row)
      for (int column = static_cast<int>(from.x() / bucket_m_);
           column <= static_cast<int>(to.x() / bucket_m_); ++column) {
        const Eigen::Vector2d middle = corner_m_ + bucket_m_ * Eigen::Vector2d(column + 0.5, row + 0.5);
        if (row < rows_ && column < columns_ && touches_square(s, middle, 0.5 * bucket_m_ + kSlack_m))
          lists[bucket(column, row)].push_back(static_cast<std::uint32_t>(i));
      }
  }
  first_.push_back(0);
  for (const auto& list : lists) {
    entries_.insert(entries_.end(), list.begin(), list.end());
    first_.push_back(static_cast<std::uint32_t>(entries_.size()));
  }
}

std::size_t SegmentIndex::bucket(int column, int row) const {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
         static_cast<std::size_t>(column);
}

std::optional<RayHit> SegmentIndex::cast(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction,
                                         double max_range_m) const {
  if (segments_.empty()) return std::nullopt;
  // Where the ray enters the grid's rectangle, and where it leaves it.
  double enter = 0.0, leave = max_range_m;
  const Eigen::Vector2d size(columns_ * bucket_m_, rows_ * bucket_m_);
  for (int axis = 0; axis < 2; ++axis) {
    const double low = corner_m_[axis] - origin_m[axis], high = low + size[axis];
    if (direction[axis] == 0.0) {
      if (low > 0 || high < 0) return std::nullopt;
      continue;
    }
    const double t0 = low / direction[axis], t1 = high / direction[axis];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  if (!(enter <= leave)) return std::nullopt;

  const Eigen::Vector2d start = (origin_m + enter * direction - corner_m_) / bucket_m_;
  const int column = std::clamp(static_cast<int>(start.x()), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(start.y()), 0, rows_ - 1);
  const AxisWalk x = walk_axis(start.x(), column, direction.x(), bucket_m_);
  const AxisWalk y = walk_axis(start.y(), row, direction.y(), bucket_m_);
  Walk walk{column, row, x.step, y.step, enter + x.next_m, enter + y.next_m, x.per_bucket_m, y.per_bucket_m};

  double best = max_range_m;
  std::optional<std::size_t> hit;
  while (walk.column >= 0 && walk.row >= 0 && walk.column < columns_ && walk.row < rows_) {
    const std::size_t b = bucket(walk.column, walk.row);
    for (std::uint32_t e = first_[b]; e < first_[b + 1]; ++e) {
      const double range = meet(origin_m, direction, segments_[entries_[e]]);
      if (range < best || (range == best && hit && entries_[e] < *hit)) {
        best = range;
        hit = entries_[e];
      }
    }
    if (best <= walk.leaves_at_m()) break;
    walk.advance();
  }
  if (!hit) return std::nullopt;
  const Eigen::Vector2d edge = segments_[*hit].b - segments_[*hit].a;
  return RayHit{best, std::abs(cross(direction, edge)) / edge.norm(), *hit};
}

double SegmentIndex::clearance(const Eigen::Vector2d& point_m, double max_m) const {
  const Eigen::Vector2d at = (point_m - corner_m_) / bucket_m_;
  double best = max_m;
  const auto look_in = [&](int column, int row) {
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return;
    const std::size_t b = bucket(column, row);
    for (std::uint32_t e = first_[b]; e < first_[b + 1]; ++e)
      best = std::min(best, distance(point_m, segments_[entries_[e]]));
  };
  const int column = static_cast<int>(std::floor(at.x())), row = static_cast<int>(std::floor(at.y()));
  // Ring k holds nothing nearer than k - 1 buckets.
  for (int ring = 0; (ring - 1) * bucket_m_ < best; ++ring)
    for (int r = -ring; r <= ring; ++r)
      for (int c = -ring; c <= ring; c += std::abs(r) == ring || ring == 0 ? 1 : 2 * ring)
        look_in(column + c, row + r);
  return best;
}

bool SegmentIndex::blocked(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) const {
  const double range = (to_m - from_m).norm();
  return range > 0 && cast(from_m, (to_m - from_m) / range, range).has_value();
}

}  // namespace mstsl::sim
