#include "mstsl/mapping/submap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mstsl {
namespace {

constexpr double kCell_m = 0.1;
constexpr double kSigma_m = 0.15;  // of the search's likelihood: a cell and a half

void add_fields(const Keyframe& keyframe, const Pose2& frame_T_base,
                const Eigen::Vector2d& magnetometer_base_m, std::vector<FieldAt>& fields) {
  for (const joint::Station& station : keyframe.stations) {
    const Pose2 then = frame_T_base * station.base_T_then;
    const Eigen::Vector2d level = then.rotation() * station.base_field_uT.head<2>();
    fields.push_back(
        {then * magnetometer_base_m, {level.x(), level.y(), station.base_field_uT.z()}, then.yaw});
  }
}

/// Cells with a point in them are walls, all others free: what a scan does not show is not looked at.
OccupancyGrid cells_of(const PointSet& points_m) {
  constexpr double kMargin_m = 1.0;
  Eigen::Array2d low = points_m.front().array(), high = low;
  for (const Eigen::Vector2d& p : points_m) low = low.min(p.array()), high = high.max(p.array());
  low = ((low - kMargin_m) / kCell_m).floor() * kCell_m;
  const Eigen::Array2i size = ((high + kMargin_m - low) / kCell_m).ceil().cast<int>();
  OccupancyGrid grid(
      {.resolution_m = kCell_m, .columns = size.x(), .rows = size.y(), .map_T_grid = {low.x(), low.y(), 0}},
      CellState::kFree);
  for (const Eigen::Vector2d& p : points_m) grid[grid.geometry().cell_at(p)] = CellState::kOccupied;
  return grid;
}

ScannedWallsOptions walls_around(const PointSet& points_m) {
  double reach_m = 1.0;
  for (const Eigen::Vector2d& p : points_m) reach_m = std::max(reach_m, p.cwiseAbs().maxCoeff());
  return {.half_size_m = reach_m + 1.0};
}

PointSet all_points(const std::vector<Keyframe>& keyframes, const Pose2& chain_T_origin) {
  PointSet points_m;
  for (const Keyframe& k : keyframes) {
    const Pose2 origin_T_base = between(chain_T_origin, k.chain_T_base);
    for (const FacedPoint& p : k.points_base_m) points_m.push_back(origin_T_base * p.point_m);
  }
  return points_m;
}

}  // namespace

double Submap::distance_m(const Eigen::Vector2d& point_m) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p : way_m) nearest_m = std::min(nearest_m, (p - point_m).norm());
  return nearest_m;
}

Stretch stretch_of(std::span<const Keyframe> keyframes, std::size_t origin,
                   const Eigen::Vector2d& magnetometer_base_m, double spacing_m) {
  Stretch stretch;
  PointSet points_m;
  // The newest scan first: of points that lie near each other the first is kept.
  for (std::size_t i = keyframes.size(); i-- > 0;) {
    const Pose2 origin_T_base = between(keyframes[origin].chain_T_base, keyframes[i].chain_T_base);
    for (const FacedPoint& p : keyframes[i].points_base_m) points_m.push_back(origin_T_base * p.point_m);
  }
  for (const Keyframe& k : keyframes)
    add_fields(k, between(keyframes[origin].chain_T_base, k.chain_T_base), magnetometer_base_m,
               stretch.fields);
  stretch.points_m = thinned(points_m, spacing_m);
  return stretch;
}

SubmapWalls::SubmapWalls(const Submap& submap)
    : walls({0, 0}, walls_around(all_points(submap.keyframes,
                                            submap.keyframes[submap.origin - submap.first].chain_T_base))) {
  const Pose2 chain_T_origin = submap.keyframes[submap.origin - submap.first].chain_T_base;
  for (const Keyframe& k : submap.keyframes) {
    const Pose2 origin_T_base = between(chain_T_origin, k.chain_T_base);
    walls.add(k.points_base_m, origin_T_base);
    add_fields(k, origin_T_base, submap.magnetometer_base_m, fields);
  }
  const PointSet points_m = all_points(submap.keyframes, chain_T_origin);
  if (!points_m.empty())
    cells = std::make_unique<const MatchMap>(cells_of(points_m), LikelihoodOptions{.sigma_m = kSigma_m}, 6);
}

}  // namespace mstsl
