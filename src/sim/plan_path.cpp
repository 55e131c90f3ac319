#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "mstsl/sim/route.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;
using Path = std::vector<Vector2d>;

/// How many times longer a way at the least clearance counts than one at the preferred, and one beside the
/// lanes than one on them: robots keep to corridors and aisles, though an empty bay may be free.
constexpr double kHugging = 3.0;
constexpr double kBesideLanes = 3.0;

/// What a metre of way costs at each place.
class Costs {
 public:
  Costs(const World& world, const PathOptions& options)
      : clearance_(world.clearance_m()), on_lane_(world.on_lane()), options_(options) {}

  const GridGeometry& geometry() const { return clearance_.geometry(); }
  bool passable(Cell cell) const {
    return clearance_.contains(cell) && clearance_[cell] >= options_.clearance_m;
  }

  /// Of a passable cell, at least 1.
  double per_metre(Cell cell) const {
    const double span = std::max(1e-6, options_.preferred_clearance_m - options_.clearance_m);
    const double lack = std::clamp((options_.preferred_clearance_m - clearance_[cell]) / span, 0.0, 1.0);
    return (1.0 + (kHugging - 1.0) * lack) * (on_lane_[cell] ? 1.0 : kBesideLanes);
  }

  /// Of the straight way; infinite if it is not passable.
  double between(const Vector2d& a, const Vector2d& b) const {
    const double whole_m = (b - a).norm();
    const int steps = 1 + static_cast<int>(whole_m / geometry().resolution_m);
    double sum = 0.0;
    for (int i = 0; i <= steps; ++i) {
      const Cell cell = geometry().cell_at(a + (b - a) * (static_cast<double>(i) / steps));
      if (!passable(cell)) return std::numeric_limits<double>::infinity();
      sum += per_metre(cell);
    }
    return whole_m * sum / (steps + 1);
  }

 private:
  const Grid<float>& clearance_;
  const Grid<std::uint8_t>& on_lane_;
  const PathOptions& options_;
};

class Search {
 public:
  explicit Search(const Costs& costs)
      : costs_(costs),
        cost_(costs.geometry(), std::numeric_limits<double>::infinity()),
        from_(costs.geometry(), 0) {}

  /// A* from cell to cell; empty if there is no way.
  std::vector<Cell> run(Cell start, Cell goal) {
    cost_[start] = 0.0;
    push(start, goal);
    while (!open_.empty()) {
      const auto [estimate, index] = open_.top();
      open_.pop();
      const Cell cell = costs_.geometry().cell(index);
      if (cell == goal) return way_back(start, goal);
      if (estimate > cost_[cell] + to_go(cell, goal) + 1e-9) continue;  // a better way was found since
      expand(cell, goal);
    }
    return {};
  }

 private:
  using Entry = std::pair<double, std::size_t>;

  double to_go(Cell cell, Cell goal) const {
    return costs_.geometry().resolution_m * std::hypot(cell.column - goal.column, cell.row - goal.row);
  }

  void push(Cell cell, Cell goal) {
    open_.emplace(cost_[cell] + to_go(cell, goal), costs_.geometry().index(cell));
  }

  void expand(Cell cell, Cell goal) {
    for (int row = -1; row <= 1; ++row)
      for (int column = -1; column <= 1; ++column) {
        const Cell next{cell.column + column, cell.row + row};
        if ((row == 0 && column == 0) || !costs_.passable(next)) continue;
        const double step_m = costs_.geometry().resolution_m * std::hypot(row, column);
        const double cost = cost_[cell] + step_m * costs_.per_metre(next);
        if (cost >= cost_[next]) continue;
        cost_[next] = cost;
        from_[next] = costs_.geometry().index(cell);
        push(next, goal);
      }
  }

  std::vector<Cell> way_back(Cell start, Cell goal) const {
    std::vector<Cell> cells{goal};
    while (!(cells.back() == start)) cells.push_back(costs_.geometry().cell(from_[cells.back()]));
    std::reverse(cells.begin(), cells.end());
    return cells;
  }

  const Costs& costs_;
  Grid<double> cost_;
  Grid<std::size_t> from_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

/// Replaces stretches by straight lines that cost no more.
Path straightened(const Path& path, const Costs& costs) {
  constexpr std::size_t kLongest = 300;  // points looked ahead
  constexpr double kTolerance = 1.02;    // of a stretch's cost: costs are sampled
  Path straight{path.front()};
  for (std::size_t at = 0; at + 1 < path.size();) {
    std::size_t next = at + 1;
    double stretch = costs.between(path[at], path[next]);
    for (std::size_t i = at + 2; i < std::min(path.size(), at + kLongest); ++i) {
      stretch += costs.between(path[i - 1], path[i]);
      if (costs.between(path[at], path[i]) <= kTolerance * stretch) next = i;
    }
    straight.push_back(path[next]);
    at = next;
  }
  return straight;
}

/// The cell of a point, or of the nearest place around it with enough clearance.
std::optional<Cell> cell_near(const Costs& costs, const Vector2d& point_m) {
  constexpr int kReach = 3;
  const Cell middle = costs.geometry().cell_at(point_m);
  std::optional<Cell> best;
  double best_m = std::numeric_limits<double>::infinity();
  for (int row = -kReach; row <= kReach; ++row)
    for (int column = -kReach; column <= kReach; ++column) {
      const Cell cell{middle.column + column, middle.row + row};
      if (!costs.passable(cell)) continue;
      const double away_m = (costs.geometry().center_of(cell) - point_m).norm();
      if (away_m < best_m) best = cell, best_m = away_m;
    }
  return best;
}

Error not_drivable(const Vector2d& point_m) {
  return Error("the point (" + std::to_string(point_m.x()) + ", " + std::to_string(point_m.y()) +
               ") is not on ground that the robot can drive on; choose one with more room around it");
}

}  // namespace

Result<Path> plan_path(const World& world, const Vector2d& start_m, const Vector2d& goal_m,
                       const PathOptions& options) {
  const Costs costs(world, options);
  const auto start = cell_near(costs, start_m);
  if (!start) return not_drivable(start_m);
  const auto goal = cell_near(costs, goal_m);
  if (!goal) return not_drivable(goal_m);
  if (costs.between(start_m, goal_m) <= 1.05 * (goal_m - start_m).norm()) return Path{start_m, goal_m};
  const std::vector<Cell> cells = Search(costs).run(*start, *goal);
  if (cells.empty())
    return Error("no way leads from (" + std::to_string(start_m.x()) + ", " + std::to_string(start_m.y()) +
                 ") to (" + std::to_string(goal_m.x()) + ", " + std::to_string(goal_m.y()) + ")");
  Path path;
  for (const Cell cell : cells) path.push_back(costs.geometry().center_of(cell));
  path.front() = start_m;
  path.back() = goal_m;
  return straightened(path, costs);
}

}  // namespace mstsl::sim
