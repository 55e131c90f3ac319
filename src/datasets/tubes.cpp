#include "mstsl/datasets/tubes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "mstsl/grid/outline.hpp"
#include "mstsl/sim/segment.hpp"

namespace mstsl::datasets {
namespace {

constexpr double kLargestBuilding_m = 2000.0;

Eigen::AlignedBox2d bounds_of(std::span<const Path> paths_m) {
  Eigen::AlignedBox2d bounds;
  for (const Path& path_m : paths_m)
    for (const Eigen::Vector2d& point_m : path_m) bounds.extend(point_m);
  return bounds;
}

bool all_finite(std::span<const Path> paths_m) {
  return std::all_of(paths_m.begin(), paths_m.end(), [](const Path& path_m) {
    return std::all_of(path_m.begin(), path_m.end(), [](const Eigen::Vector2d& p) { return p.allFinite(); });
  });
}

void clear_around(const sim::Segment& step, double radius_m, OccupancyGrid& grid) {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(radius_m);
  const Cell low = grid.geometry().cell_at(step.a.cwiseMin(step.b) - reach);
  const Cell high = grid.geometry().cell_at(step.a.cwiseMax(step.b) + reach);
  for (int row = low.row; row <= high.row; ++row)
    for (int column = low.column; column <= high.column; ++column)
      if (sim::distance(grid.geometry().center_of({column, row}), step) <= radius_m)
        grid[{column, row}] = CellState::kFree;
}

/// Douglas & Peucker (1973): the corners of points first .. last that are needed to stay within the
/// tolerance.
void keep_corners(const Path& path_m, std::size_t first, std::size_t last, double tolerance_m, Path& kept_m) {
  const sim::Segment chord{path_m[first], path_m[last]};
  std::size_t farthest = first;
  double apart_m = tolerance_m;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double distance_m = sim::distance(path_m[i], chord);
    if (distance_m > apart_m) {
      farthest = i;
      apart_m = distance_m;
    }
  }
  if (farthest == first) {
    kept_m.push_back(path_m[last]);
    return;
  }
  keep_corners(path_m, first, farthest, tolerance_m, kept_m);
  keep_corners(path_m, farthest, last, tolerance_m, kept_m);
}

std::vector<sim::Lane> lanes_along(const Path& path_m, double width_m) {
  Path corners_m = {path_m.front()};
  keep_corners(path_m, 0, path_m.size() - 1, width_m / 8.0, corners_m);  // a lane stays well inside its tube
  std::vector<sim::Lane> lanes;
  for (const sim::Segment& piece : sim::polyline(corners_m, false)) lanes.push_back({piece, width_m});
  return lanes;
}

/// The walls that bound the tubes: all outlines but the raster's own rim.
std::vector<sim::Segment> walls_of(const OccupancyGrid& raster) {
  const double width_m = raster.geometry().columns * raster.geometry().resolution_m;
  std::vector<sim::Segment> walls;
  for (const Polygon& outline : occupied_outlines(raster)) {
    Eigen::AlignedBox2d bounds;
    for (const Eigen::Vector2d& corner : outline) bounds.extend(corner);
    const bool is_rim = bounds.sizes().x() > width_m - 2.0 * raster.geometry().resolution_m;
    if (is_rim) continue;
    for (const sim::Segment& wall : sim::polyline(outline, true)) walls.push_back(wall);
  }
  return walls;
}

}  // namespace

Result<OccupancyGrid> tubes_around(std::span<const Path> paths_m, const TubeOptions& options) {
  const Eigen::AlignedBox2d bounds = bounds_of(paths_m);
  if (bounds.isEmpty()) return Error("no path to build corridors around");
  if (!all_finite(paths_m)) return Error("a path holds a position that is not finite");
  const double radius_m = options.width_m / 2.0;
  const double margin_m = radius_m + 2.0 * options.resolution_m;  // so that a wall closes every tube
  const Eigen::Vector2d size_m = bounds.sizes().array() + 2.0 * margin_m;
  if (size_m.maxCoeff() > kLargestBuilding_m)
    return Error(fmt::format("the paths spread over {:.0f} x {:.0f} m; no building is larger than {:.0f} m",
                             size_m.x(), size_m.y(), kLargestBuilding_m));
  GridGeometry geometry;
  geometry.resolution_m = options.resolution_m;
  geometry.columns = static_cast<int>(std::ceil(size_m.x() / options.resolution_m));
  geometry.rows = static_cast<int>(std::ceil(size_m.y() / options.resolution_m));
  geometry.map_T_grid = Pose2::from(bounds.min().array() - margin_m, 0.0);

  OccupancyGrid grid(geometry, CellState::kOccupied);
  for (const Path& path_m : paths_m) {
    if (path_m.size() == 1) clear_around({path_m.front(), path_m.front()}, radius_m, grid);
    for (const sim::Segment& step : sim::polyline(path_m, false)) clear_around(step, radius_m, grid);
  }
  return grid;
}

double shared_axis_rad(std::span<const Path> paths_m) {
  // The mean of directions that repeat every 90 deg is the mean of four times their angle, as unit vectors.
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Path& path_m : paths_m) {
    for (std::size_t i = 1; i < path_m.size(); ++i) {
      const Eigen::Vector2d step = path_m[i] - path_m[i - 1];
      const double four_times_rad = 4.0 * std::atan2(step.y(), step.x());
      sum += step.norm() * Eigen::Vector2d(std::cos(four_times_rad), std::sin(four_times_rad));
    }
  }
  return std::atan2(sum.y(), sum.x()) / 4.0;
}

Result<sim::WorldPlan> tube_plan(std::span<const Path> paths_m, const TubeOptions& options) {
  const Result<OccupancyGrid> raster = tubes_around(paths_m, options);
  if (!raster) return raster.error();
  sim::WorldPlan plan;
  plan.name = "tubes";
  plan.axis_yaw_rad = shared_axis_rad(paths_m);
  const GridGeometry& geometry = raster->geometry();
  plan.footprint_m.extend(geometry.map_T_grid.position());
  plan.footprint_m.extend(geometry.to_map({geometry.columns, geometry.rows}));
  plan.walls = walls_of(*raster);
  for (const Path& path_m : paths_m) {
    if (path_m.size() < 2) continue;
    plan.lanes = lanes_along(path_m, options.width_m);
    break;
  }
  return plan;
}

}  // namespace mstsl::datasets
