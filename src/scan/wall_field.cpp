#include "mstsl/scan/wall_field.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mstsl {
namespace {

/// n n^T of the distance's slope n at a cell, in the grid's axes: xx, xy, yy. Zero where it has none: on the
/// ridge between two walls, on a wall one cell wide, and out of reach.
Eigen::Vector3f normal_product(const DistanceField& distances, Cell cell) {
  const double here = distances.at(cell);
  if (here >= distances.max_distance_m()) return Eigen::Vector3f::Zero();
  const double dx =
      distances.at(Cell{cell.column + 1, cell.row}) - distances.at(Cell{cell.column - 1, cell.row});
  const double dy =
      distances.at(Cell{cell.column, cell.row + 1}) - distances.at(Cell{cell.column, cell.row - 1});
  const double squared = dx * dx + dy * dy;
  // Half the slope of a plain wall, squared: less is a ridge or a dip, whose direction is chance.
  const double step = distances.geometry().resolution_m;
  if (squared < step * step) return Eigen::Vector3f::Zero();
  return Eigen::Vector3d(dx * dx, dx * dy, dy * dy).cast<float>() / static_cast<float>(squared);
}

/// Sums over `radius` cells to each side, first along rows, then along columns.
Grid<Eigen::Vector3f> box_sums(const Grid<Eigen::Vector3f>& values, int radius) {
  const GridGeometry& g = values.geometry();
  const auto pass = [&](const Grid<Eigen::Vector3f>& from, int outer, int inner, bool rows) {
    Grid<Eigen::Vector3f> to(g, Eigen::Vector3f::Zero());
    for (int o = 0; o < outer; ++o) {
      for (int i = 0; i < inner; ++i) {
        Eigen::Vector3f sum = Eigen::Vector3f::Zero();
        for (int k = std::max(0, i - radius); k <= std::min(inner - 1, i + radius); ++k)
          sum += from[rows ? Cell{k, o} : Cell{o, k}];
        to[rows ? Cell{i, o} : Cell{o, i}] = sum;
      }
    }
    return to;
  };
  return pass(pass(values, g.rows, g.columns, true), g.columns, g.rows, false);
}

/// The same matrix seen in the map's axes, scaled to trace 1.
Eigen::Vector3f in_map(const Eigen::Vector3f& v, const Eigen::Matrix2f& map_R_grid) {
  const float trace = v.x() + v.z();
  if (!(trace > 0)) return Eigen::Vector3f::Zero();
  Eigen::Matrix2f m;
  m << v.x(), v.y(), v.y(), v.z();
  const Eigen::Matrix2f turned = map_R_grid * m * map_R_grid.transpose() / trace;
  return {turned(0, 0), turned(0, 1), turned(1, 1)};
}

}  // namespace

WallField::WallField(const OccupancyGrid& occupancy, const WallFieldOptions& options)
    : distances_(occupancy, options.reach_m),
      frame_(occupancy.geometry()),
      facing_(occupancy.geometry(), Eigen::Vector3f::Zero()) {
  const GridGeometry& g = geometry();
  for (std::size_t i = 0; i < g.size(); ++i) facing_.values()[i] = normal_product(distances_, g.cell(i));
  const int radius = std::max(1, static_cast<int>(std::lround(options.smoothing_m / g.resolution_m)));
  facing_ = box_sums(facing_, radius);
  const Eigen::Matrix2f map_R_grid = g.map_T_grid.rotation().cast<float>();
  for (std::size_t i = 0; i < g.size(); ++i) {
    Eigen::Vector3f& value = facing_.values()[i];
    value =
        distances_.values_m().values()[i] < reach_m() ? in_map(value, map_R_grid) : Eigen::Vector3f::Zero();
  }
}

WallField::Sample WallField::sample(const Eigen::Vector2d& map_point_m) const {
  Sample none{reach_m() * reach_m(), Eigen::Vector2d::Zero(), Eigen::Vector3d::Zero()};
  const Eigen::Vector2d from_center = frame_.to_grid(map_point_m).array() - 0.5;
  const Cell low = GridFrame::cell_of(from_center);
  const GridGeometry& g = geometry();
  if (low.column < 0 || low.row < 0 || low.column + 1 >= g.columns || low.row + 1 >= g.rows) return none;
  const std::vector<float>& d = distances_.values_m().values();
  const std::size_t i = g.index(low), up = i + static_cast<std::size_t>(g.columns);
  const auto square = [&](std::size_t k) { return static_cast<double>(d[k]) * d[k]; };
  const double d00 = square(i), d10 = square(i + 1), d01 = square(up), d11 = square(up + 1);
  const double u = from_center.x() - low.column, v = from_center.y() - low.row;
  const double low_row = d00 + u * (d10 - d00), high_row = d01 + u * (d11 - d01);
  const double squared = low_row + v * (high_row - low_row);
  if (squared >= none.squared_m2) return none;
  const Eigen::Vector2d per_cell((1 - v) * (d10 - d00) + v * (d11 - d01), high_row - low_row);
  const std::size_t nearest = (v < 0.5 ? i : up) + (u < 0.5 ? 0 : 1);
  return {squared, frame_.slope_to_map(0.5 * per_cell), facing_.values()[nearest].cast<double>()};
}

}  // namespace mstsl
