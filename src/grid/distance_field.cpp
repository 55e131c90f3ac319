#include "mstsl/grid/distance_field.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <iterator>
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

double square(int i) { return static_cast<double>(i) * i; }

/// The lower envelope of parabolas (x - tip)^2 + height, by Felzenszwalb & Huttenlocher's algorithm 1.
class LowerEnvelope {
 public:
  void clear() { pieces_.clear(); }
  bool empty() const { return pieces_.empty(); }

  /// Expects tips in ascending order.
  void add(int tip, double height) {
    double begin = -std::numeric_limits<double>::infinity();
    while (!pieces_.empty()) {
      const Piece& last = pieces_.back();
      begin = (height - last.height + square(tip) - square(last.tip)) / (2.0 * (tip - last.tip));
      if (begin > last.begin) break;
      pieces_.pop_back();
    }
    pieces_.push_back({tip, height, begin});
  }

  /// Calls `use(x, value)` for x = 0 .. width-1.
  template <typename Use>
  void for_each(int width, Use use) const {
    auto piece = pieces_.begin();
    for (int x = 0; x < width; ++x) {
      while (std::next(piece) != pieces_.end() && std::next(piece)->begin < x) ++piece;
      use(x, square(x - piece->tip) + piece->height);
    }
  }

 private:
  struct Piece {
    int tip;
    double height;
    double begin;  ///< it is the lowest from here to where the next begins
  };
  std::vector<Piece> pieces_;
};

}  // namespace

DistanceField::DistanceField(const OccupancyGrid& occupancy, double max_distance_m)
    : distances_m_(occupancy.geometry(), static_cast<float>(max_distance_m)),
      frame_(occupancy.geometry()),
      max_distance_m_(max_distance_m) {
  assert(max_distance_m > 0);
  const GridGeometry& geometry = occupancy.geometry();
  const double farthest_cells = std::hypot(geometry.columns, geometry.rows);
  const int cap =
      static_cast<int>(std::ceil(std::min(max_distance_m / geometry.resolution_m, farthest_cells))) + 1;
  const std::vector<int> in_column = column_distances(occupancy, cap);

  LowerEnvelope envelope;
  for (int row = 0; row < geometry.rows; ++row) {
    const std::size_t begin = geometry.index({0, row});
    envelope.clear();
    for (int x = 0; x < geometry.columns; ++x) {
      // A column whose nearest wall is beyond the cap cannot bring any distance below the maximum.
      if (in_column[begin + x] < cap) envelope.add(x, square(in_column[begin + x]));
    }
    if (envelope.empty()) continue;
    envelope.for_each(geometry.columns, [&](int x, double squared_cells) {
      if (squared_cells >= square(cap)) return;
      distances_m_.values()[begin + x] =
          static_cast<float>(std::min(max_distance_m, std::sqrt(squared_cells) * geometry.resolution_m));
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
