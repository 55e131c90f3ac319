#include "mstsl/grid/outline.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace mstsl {
namespace {

using Eigen::Vector2d;

/// The four ways along cell edges, counter-clockwise: east, north, west, south.
constexpr std::array<Cell, 4> kSteps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
/// The cell on the left and on the right of an edge that starts at a cell's lower left corner and goes one
/// way.
constexpr std::array<Cell, 4> kLeft{{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};
constexpr std::array<Cell, 4> kRight{{{0, -1}, {0, 0}, {-1, 0}, {-1, -1}}};

Cell operator+(Cell a, Cell b) { return {a.column + b.column, a.row + b.row}; }

bool occupied(const OccupancyGrid& map, Cell cell) {
  return map.contains(cell) && map[cell] == CellState::kOccupied;
}

/// Whether the edge from a corner in a direction has an occupied cell on its left and none on its right.
bool is_boundary(const OccupancyGrid& map, Cell corner, int way) {
  return occupied(map, corner + kLeft[static_cast<std::size_t>(way)]) &&
         !occupied(map, corner + kRight[static_cast<std::size_t>(way)]);
}

/// Which edges were walked: one bit a direction for each corner.
class Walked {
 public:
  explicit Walked(const GridGeometry& geometry)
      : columns_(static_cast<std::size_t>(geometry.columns) + 1),
        bits_(columns_ * (static_cast<std::size_t>(geometry.rows) + 1), 0) {}
  bool test(Cell corner, int way) const { return (bits_[index(corner)] >> way) & 1; }
  void set(Cell corner, int way) {
    bits_[index(corner)] = static_cast<std::uint8_t>(bits_[index(corner)] | (1 << way));
  }

 private:
  std::size_t index(Cell corner) const {
    return static_cast<std::size_t>(corner.row) * columns_ + static_cast<std::size_t>(corner.column);
  }
  std::size_t columns_;
  std::vector<std::uint8_t> bits_;
};

/// The border cells met on the way round, starting along one boundary edge.
std::vector<Cell> trace(const OccupancyGrid& map, Cell corner, int way, Walked& walked) {
  std::vector<Cell> cells;
  while (!walked.test(corner, way)) {
    walked.set(corner, way);
    const Cell cell = corner + kLeft[static_cast<std::size_t>(way)];
    if (cells.empty() || !(cells.back() == cell)) cells.push_back(cell);
    corner = corner + kSteps[static_cast<std::size_t>(way)];
    // Right first: where two occupied cells touch at a corner only, the outline goes over to the other.
    for (const int turn : {3, 0, 1}) {
      const int next = (way + turn) % 4;
      if (is_boundary(map, corner, next)) {
        way = next;
        break;
      }
    }
  }
  while (cells.size() > 1 && cells.front() == cells.back()) cells.pop_back();
  return cells;
}

double distance_to_chord(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double squared = along.squaredNorm();
  const double share = squared > 0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (p - a - share * along).norm();
}

/// Marks the points of first..last to keep, both ends included (Douglas & Peucker 1973), without recursion.
void keep_between(const Polygon& points, std::size_t first, std::size_t last, double tolerance_m,
                  std::vector<bool>& keep) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    keep[from] = keep[to % points.size()] = true;
    double worst = tolerance_m;
    std::size_t split = from;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double d = distance_to_chord(points[i], points[from], points[to % points.size()]);
      if (d > worst) worst = d, split = i;
    }
    if (split != from) open.insert(open.end(), {{from, split}, {split, to}});
  }
}

Polygon simplified(const Polygon& points, double tolerance_m) {
  if (points.size() < 3) return points;
  std::size_t farthest = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    if ((points[i] - points[0]).squaredNorm() > (points[farthest] - points[0]).squaredNorm()) farthest = i;
  std::vector<bool> keep(points.size(), false);
  keep_between(points, 0, farthest, tolerance_m, keep);
  keep_between(points, farthest, points.size(), tolerance_m, keep);
  Polygon kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (keep[i]) kept.push_back(points[i]);
  return kept;
}

/// A lone cell as a square half its size.
Polygon small_square(const GridGeometry& geometry, Cell cell) {
  const Vector2d middle(cell.column + 0.5, cell.row + 0.5);
  Polygon square;
  for (const Vector2d& corner :
       {Vector2d(-0.25, -0.25), Vector2d(0.25, -0.25), Vector2d(0.25, 0.25), Vector2d(-0.25, 0.25)})
    square.push_back(geometry.to_map(middle + corner));
  return square;
}

}  // namespace

std::vector<Polygon> occupied_outlines(const OccupancyGrid& map, double tolerance_m) {
  const GridGeometry& geometry = map.geometry();
  const double tolerance = tolerance_m < 0 ? geometry.resolution_m : tolerance_m;
  Walked walked(geometry);
  std::vector<Polygon> outlines;
  // Every closed boundary has an edge that goes east, so looking for those finds all.
  for (int row = 0; row < geometry.rows; ++row)
    for (int column = 0; column < geometry.columns; ++column) {
      const Cell corner{column, row};
      if (!is_boundary(map, corner, 0) || walked.test(corner, 0)) continue;
      const std::vector<Cell> cells = trace(map, corner, 0, walked);
      if (cells.size() == 1) {
        outlines.push_back(small_square(geometry, cells.front()));
        continue;
      }
      Polygon points;
      for (const Cell cell : cells) points.push_back(geometry.center_of(cell));
      outlines.push_back(simplified(points, tolerance));
    }
  return outlines;
}

}  // namespace mstsl
