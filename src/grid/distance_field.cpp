#include "mstsl/grid/distance_field.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace mstsl {
namespace {

/// For each cell the distance (cells) to the nearest occupied one in its own column, at most `cap`.
std::vector<int> column_distances(const OccupancyGrid& occupancy, int cap) {
  const auto columns = static_cast<std::size_t>(occupancy.geometry().columns);
  const std::vector<CellState>& states = occupancy.values();
  std::vector<int> distances(states.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    const int from_below = i < columns ? cap : std::min(cap, distances[i - columns] + 1);
    distances[i] = states[i] == CellState::kOccupied ? 0 : from_below;
  }
  for (std::size_t i = states.size(); i-- > columns;) {
    distances[i - columns] = std::min(distances[i - columns], distances[i] + 1);
  }
  return distances;
}

/// The lower envelope of the parabolas (x - i)^2 + heights[i], by Felzenszwalb & Huttenlocher's algorithm 1.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(int width) : tips_(width), begins_(width + 1) {}

  void build(const std::vector<double>& heights) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    count_ = 0;
    for (int i = 0; i < static_cast<int>(heights.size()); ++i) {
      double begin = -kInfinity;
      while (count_ > 0 && (begin = meeting(heights, tips_[count_ - 1], i)) <= begins_[count_ - 1]) --count_;
      if (count_ == 0) begin = -kInfinity;
      tips_[count_] = i;
      begins_[count_] = begin;
      ++count_;
    }
  }

  /// Calls `use(x, i)` for x = 0 .. width-1 with the parabola i that is lowest there.
  template <typename Use>
  void for_each(int width, Use use) const {
    for (int x = 0, k = 0; x < width; ++x) {
      while (k + 1 < count_ && begins_[k + 1] < x) ++k;
      use(x, tips_[k]);
    }
  }

 private:
  /// Where the parabola of j, further right, passes under that of i.
  static double meeting(const std::vector<double>& heights, int i, int j) {
    return (heights[j] - heights[i] + static_cast<double>(j) * j - static_cast<double>(i) * i) /
           (2.0 * (j - i));
  }

  std::vector<int> tips_;
  std::vector<double> begins_;
  int count_ = 0;
};

}  // namespace

DistanceField::DistanceField(const OccupancyGrid& occupancy, double max_distance_m)
    : distances_m_(occupancy.geometry(), static_cast<float>(max_distance_m)),
      frame_(occupancy.geometry()),
      max_distance_m_(max_distance_m) {
  assert(max_distance_m > 0);
  const GridGeometry& geometry = occupancy.geometry();
  if (geometry.size() == 0) return;
  // Nothing farther than the cap can come out below the maximum, so the sums stay small and exact.
  const double farthest = std::hypot(geometry.columns, geometry.rows);
  const int cap = static_cast<int>(std::ceil(std::min(max_distance_m / geometry.resolution_m, farthest))) + 1;
  const std::vector<int> in_column = column_distances(occupancy, cap);
  const double cap_squared = static_cast<double>(cap) * cap;

  LowerEnvelope envelope(geometry.columns);
  std::vector<double> heights(static_cast<std::size_t>(geometry.columns));
  for (int row = 0; row < geometry.rows; ++row) {
    const std::size_t begin = geometry.index({0, row});
    for (std::size_t x = 0; x < heights.size(); ++x)
      heights[x] = static_cast<double>(in_column[begin + x]) * in_column[begin + x];
    envelope.build(heights);
    envelope.for_each(geometry.columns, [&](int x, int tip) {
      const double squared = static_cast<double>(x - tip) * (x - tip) + heights[tip];
      if (squared >= cap_squared) return;  // no wall within the cap: the maximum stands
      distances_m_.values()[begin + x] =
          static_cast<float>(std::min(max_distance_m, std::sqrt(squared) * geometry.resolution_m));
    });
  }
}

double DistanceField::at(const Eigen::Vector2d& map_point_m) const {
  const Eigen::Vector2d cells = frame_.to_grid(map_point_m);
  if (!distances_m_.contains(GridFrame::cell_of(cells))) return max_distance_m_;
  const Eigen::Vector2d from_center = cells.array() - 0.5;
  const Cell low = GridFrame::cell_of(from_center);
  const double u = from_center.x() - low.column, v = from_center.y() - low.row;
  const auto clamped = [&](int column, int row) {
    return static_cast<double>(distances_m_[{std::clamp(column, 0, geometry().columns - 1),
                                             std::clamp(row, 0, geometry().rows - 1)}]);
  };
  return (1 - v) * ((1 - u) * clamped(low.column, low.row) + u * clamped(low.column + 1, low.row)) +
         v * ((1 - u) * clamped(low.column, low.row + 1) + u * clamped(low.column + 1, low.row + 1));
}

}  // namespace mstsl
