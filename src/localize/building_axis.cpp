#include "mstsl/localize/building_axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

/// Occupied cells that border on free space: the faces of the walls, however thick these are drawn.
std::vector<Eigen::Vector2d> wall_faces(const OccupancyGrid& map) {
  std::vector<Eigen::Vector2d> faces;
  const GridGeometry& geometry = map.geometry();
  for (std::size_t i = 0; i < geometry.size(); ++i) {
    if (map.values()[i] != CellState::kOccupied) continue;
    const Cell cell = geometry.cell(i);
    for (const Cell next : {Cell{cell.column - 1, cell.row}, Cell{cell.column + 1, cell.row},
                            Cell{cell.column, cell.row - 1}, Cell{cell.column, cell.row + 1}}) {
      if (!map.contains(next) || map[next] != CellState::kFree) continue;
      faces.emplace_back(cell.column, cell.row);
      break;
    }
  }
  return faces;
}

/// How much the points, projected on `direction`, fall together: the sum of squared counts over bins of one
/// cell, each point shared between the two nearest so that the sum is smooth in the angle.
double concentration(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& direction,
                     std::vector<double>& bins) {
  std::fill(bins.begin(), bins.end(), 0.0);
  const double middle = static_cast<double>(bins.size()) / 2;
  for (const Eigen::Vector2d& point : points) {
    const double place = point.dot(direction) + middle;
    const auto low = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(low);
    bins[low] += 1.0 - share;
    bins[low + 1] += share;
  }
  double sum = 0.0;
  for (const double bin : bins) sum += bin * bin;
  return sum;
}

class AngleSearch {
 public:
  AngleSearch(const std::vector<Eigen::Vector2d>& points, double diagonal_cells)
      : points_(points), bins_(2 * static_cast<std::size_t>(diagonal_cells) + 4) {}

  /// The best of the angles `center` + i * `step`, |i| <= `reach`.
  double best(double center_rad, double step_rad, int reach) {
    double best_angle = center_rad, best_value = -1.0;
    for (int i = -reach; i <= reach; ++i) {
      const double angle = center_rad + i * step_rad;
      const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
      const double value =
          concentration(points_, along, bins_) + concentration(points_, {-along.y(), along.x()}, bins_);
      if (value > best_value) best_value = value, best_angle = angle;
    }
    return best_angle;
  }

 private:
  const std::vector<Eigen::Vector2d>& points_;
  std::vector<double> bins_;
};

/// The same axis in (-pi/4, pi/4].
double to_quarter(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, kPi / 2);
  return wrapped <= -kPi / 4 ? kPi / 4 : wrapped;
}

}  // namespace

std::optional<double> building_axis(const OccupancyGrid& map) {
  const std::vector<Eigen::Vector2d> faces = wall_faces(map);
  if (faces.empty()) return std::nullopt;
  const GridGeometry& geometry = map.geometry();
  AngleSearch search(faces, std::hypot(geometry.columns, geometry.rows));
  double angle = search.best(0.0, radians(0.5), 90);
  angle = search.best(angle, radians(0.05), 10);
  angle = search.best(angle, radians(0.01), 5);
  return to_quarter(geometry.map_T_grid.yaw + angle);
}

}  // namespace mstsl
