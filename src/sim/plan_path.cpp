#include <algorithm>
#include <cmath>
#include <cstddef>
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

/// How many times longer a way at the least clearance counts than one at the preferred.
constexpr double kHugging = 3.0;

double clearance_at(const Grid<float>& clearance, const Vector2d& point_m) {
  const Cell cell = clearance.geometry().cell_at(point_m);
  return clearance.contains(cell) ? clearance[cell] : 0.0;
}

/// The least clearance on the straight way.
double clearance_between(const Grid<float>& clearance, const Vector2d& a, const Vector2d& b) {
  const int steps = 1 + static_cast<int>((b - a).norm() / clearance.geometry().resolution_m);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i) least = std::min(least, clearance_at(clearance, a + (b - a) * (static_cast<double>(i) / steps)));
  return least;
}

/// Cost of a metre at a clearance.
double cost_per_metre(double clearance_m, const PathOptions& options) {
  const double span = std::max(1e-6, options.preferred_clearance_m - options.clearance_m);
  const double lack = std::clamp((options.preferred_clearance_m - clearance_m) / span, 0.0, 1.0);
  return 1.0 + (kHugging - 1.0) * lack;
}

class Search {
 public:
  Search(const Grid<float>& clearance, const PathOptions& options)
      : clearance_(clearance), options_(options), cost_(clearance.geometry(), std::numeric_limits<double>::infinity()),
        from_(clearance.geometry(), 0) {}

  /// A* from cell to cell; empty if there is no way.
  std::vector<Cell> run(Cell start, Cell goal) {
    cost_[start] = 0.0;
    push(start, goal);
    while (!open_.empty()) {
      const auto [estimate, index] = open_.top();
      open_.pop();
      const Cell cell = clearance_.geometry().cell(index);
      if (cell == goal) return way_back(start, goal);
      if (estimate > cost_[cell] + to_go(cell, goal) + 1e-9) continue;  // a better way was found since
      expand(cell, goal);
    }
    return {};
  }

 private:
  using Entry = std::pair<double, std::size_t>;

  double to_go(Cell cell, Cell goal) const {
    return clearance_.geometry().resolution_m * std::hypot(cell.column - goal.column, cell.row - goal.row);
  }

  void push(Cell cell, Cell goal) { open_.emplace(cost_[cell] + to_go(cell, goal), clearance_.geometry().index(cell)); }

  void expand(Cell cell, Cell goal) {
    for (int row = -1; row <= 1; ++row)
      for (int column = -1; column <= 1; ++column) {
        const Cell next{cell.column + column, cell.row + row};
        if ((row == 0 && column == 0) || !clearance_.contains(next) || clearance_[next] < options_.clearance_m) continue;
        const double step_m = clearance_.geometry().resolution_m * std::hypot(row, column);
        const double cost = cost_[cell] + step_m * cost_per_metre(clearance_[next], options_);
        if (cost >= cost_[next]) continue;
        cost_[next] = cost;
        from_[next] = clearance_.geometry().index(cell);
        push(next, goal);
      }
  }

  std::vector<Cell> way_back(Cell start, Cell goal) const {
    std::vector<Cell> cells{goal};
    while (!(cells.back() == start)) cells.push_back(clearance_.geometry().cell(from_[cells.back()]));
    std::reverse(cells.begin(), cells.end());
    return cells;
  }

  const Grid<float>& clearance_;
  const PathOptions& options_;
  Grid<double> cost_;
  Grid<std::size_t> from_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

/// Replaces stretches by straight lines that keep as far from the walls as the stretch did (or as is preferred).
Path straightened(const Path& path, const Grid<float>& clearance, const PathOptions& options) {
  constexpr std::size_t kLongest = 150;  // cells looked ahead
  Path straight{path.front()};
  for (std::size_t at = 0; at + 1 < path.size();) {
    std::size_t next = at + 1;
    double kept_m = options.preferred_clearance_m;
    for (std::size_t i = at + 1; i < std::min(path.size(), at + kLongest); ++i) {
      kept_m = std::min(kept_m, clearance_at(clearance, path[i]));
      if (clearance_between(clearance, path[at], path[i]) >= kept_m - 0.5 * clearance.geometry().resolution_m) next = i;
    }
    straight.push_back(path[next]);
    at = next;
  }
  return straight;
}

/// The cell of a point, or of the nearest place around it with enough clearance.
std::optional<Cell> cell_near(const Grid<float>& clearance, const Vector2d& point_m, double clearance_m) {
  constexpr int kReach = 3;
  const Cell middle = clearance.geometry().cell_at(point_m);
  std::optional<Cell> best;
  double best_m = std::numeric_limits<double>::infinity();
  for (int row = -kReach; row <= kReach; ++row)
    for (int column = -kReach; column <= kReach; ++column) {
      const Cell cell{middle.column + column, middle.row + row};
      if (!clearance.contains(cell) || clearance[cell] < clearance_m) continue;
      const double away_m = (clearance.geometry().center_of(cell) - point_m).norm();
      if (away_m < best_m) best = cell, best_m = away_m;
    }
  return best;
}

Error not_drivable(const Vector2d& point_m) {
  return Error("the point (" + std::to_string(point_m.x()) + ", " + std::to_string(point_m.y()) +
               ") is not on ground that the robot can drive on; choose one with more room around it");
}

}  // namespace

Result<Path> plan_path(const World& world, const Vector2d& start_m, const Vector2d& goal_m, const PathOptions& options) {
  const Grid<float>& clearance = world.clearance_m();
  if (clearance_between(clearance, start_m, goal_m) >= options.clearance_m) return Path{start_m, goal_m};
  const auto start = cell_near(clearance, start_m, options.clearance_m);
  if (!start) return not_drivable(start_m);
  const auto goal = cell_near(clearance, goal_m, options.clearance_m);
  if (!goal) return not_drivable(goal_m);
  const std::vector<Cell> cells = Search(clearance, options).run(*start, *goal);
  if (cells.empty())
    return Error("no way leads from (" + std::to_string(start_m.x()) + ", " + std::to_string(start_m.y()) + ") to (" +
                 std::to_string(goal_m.x()) + ", " + std::to_string(goal_m.y()) + ")");
  Path path;
  for (const Cell cell : cells) path.push_back(clearance.geometry().center_of(cell));
  path.front() = start_m;
  path.back() = goal_m;
  return straightened(path, clearance, options);
}

}  // namespace mstsl::sim
