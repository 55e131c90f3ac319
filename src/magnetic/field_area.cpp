#include "field_area.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "mstsl/grid/distance_field.hpp"

namespace mstsl {
namespace {

using Eigen::Vector2d;

constexpr double kMaxCells = 100e6;  // what a field map file may hold; 500 m squared at 5 cm
constexpr int kBorderCells = 2;

/// A box in the grid's frame, in m.
struct Box {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity());
  Vector2d high = Vector2d::Constant(-std::numeric_limits<double>::infinity());
  void include(const Vector2d& p, double margin_m) {
    low = low.cwiseMin(p - Vector2d::Constant(margin_m));
    high = high.cwiseMax(p + Vector2d::Constant(margin_m));
  }
};

Box box_of(std::span<const Fingerprint> fingerprints, const OccupancyGrid* occupancy, const Pose2& grid_T_map,
           double margin_m) {
  Box box;
  for (const Fingerprint& f : fingerprints) box.include(grid_T_map * f.position_m, margin_m);
  if (occupancy == nullptr) return box;
  const GridGeometry& g = occupancy->geometry();
  for (int row = 0; row < g.rows; ++row)
    for (int column = 0; column < g.columns; ++column)
      if ((*occupancy)[{column, row}] == CellState::kFree)
        box.include(grid_T_map * g.center_of({column, row}), (kBorderCells + 1) * g.resolution_m);
  return box;
}

/// The grid that covers the box, its cells' corners at whole multiples of the resolution from the frame's
/// origin.
Result<GridGeometry> geometry_over(const Box& box, const Pose2& map_T_frame, double resolution_m) {
  const Eigen::Array2d low = (box.low.array() / resolution_m).floor(),
                       high = (box.high.array() / resolution_m).ceil();
  const Eigen::Array2d cells = (high - low).max(1.0);
  if (!(cells.prod() <= kMaxCells))
    return Error(
        fmt::format("the survey and its map span {:.0f} x {:.0f} m, more than {:.0f} million cells of {} m; "
                    "take coarser cells or a part of it",
                    cells.x() * resolution_m, cells.y() * resolution_m, kMaxCells / 1e6, resolution_m));
  GridGeometry geometry;
  geometry.resolution_m = resolution_m;
  geometry.columns = static_cast<int>(cells.x());
  geometry.rows = static_cast<int>(cells.y());
  geometry.map_T_grid = Pose2::from(map_T_frame * Vector2d(low * resolution_m), map_T_frame.yaw);
  return geometry;
}

bool free_nearby(const OccupancyGrid& occupancy, const Vector2d& map_point_m) {
  const Cell center = occupancy.geometry().cell_at(map_point_m);
  for (int row = center.row - kBorderCells; row <= center.row + kBorderCells; ++row)
    for (int column = center.column - kBorderCells; column <= center.column + kBorderCells; ++column)
      if (occupancy.contains({column, row}) && occupancy[{column, row}] == CellState::kFree) return true;
  return false;
}

}  // namespace

std::vector<float> distances_to(std::span<const Fingerprint> fingerprints, const GridGeometry& geometry,
                                double far_m) {
  OccupancyGrid marks(geometry, CellState::kFree);
  for (const Fingerprint& f : fingerprints) {
    const Cell cell = geometry.cell_at(f.position_m);
    if (marks.contains(cell)) marks[cell] = CellState::kOccupied;
  }
  return DistanceField(marks, far_m).values_m().values();
}

Result<FieldArea> make_field_area(std::span<const Fingerprint> fingerprints, const OccupancyGrid* occupancy,
                                  double resolution_m, double reach_m, double far_m) {
  if (!(resolution_m >= 0.005 && resolution_m <= 10.0 && reach_m >= 0.0))
    return Error(
        fmt::format("cells of {} m, valued up to {} m from a fingerprint: give a resolution from 0.005 to 10 "
                    "m and a reach of 0 or more",
                    resolution_m, reach_m));
  constexpr double kSurveyedBeyondFree_m =
      0.3;  // half a robot's width: where a drive cuts an unmapped corner
  const double reach = occupancy != nullptr ? std::min(reach_m, kSurveyedBeyondFree_m) : reach_m;
  const Pose2 map_T_frame = occupancy != nullptr ? occupancy->geometry().map_T_grid : Pose2{};
  const auto geometry = geometry_over(
      box_of(fingerprints, occupancy, inverse(map_T_frame), reach + resolution_m), map_T_frame, resolution_m);
  if (!geometry) return geometry.error();
  FieldArea area;
  area.geometry = *geometry;
  area.far_m = static_cast<float>(std::max(far_m, reach + resolution_m));
  area.distance_m = distances_to(fingerprints, area.geometry, area.far_m);
  area.wanted.resize(area.geometry.size());
  for (std::size_t i = 0; i < area.wanted.size(); ++i)
    area.wanted[i] =
        area.distance_m[i] <= reach ||
        (occupancy != nullptr && free_nearby(*occupancy, area.geometry.center_of(area.geometry.cell(i))));
  return area;
}

}  // namespace mstsl
