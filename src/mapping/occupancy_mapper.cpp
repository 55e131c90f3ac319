#include "mstsl/mapping/occupancy_mapper.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "mstsl/scan/points.hpp"

namespace mstsl {
namespace {

/// Whole cells from `low` to `high`, both included.
struct CellBox {
  Eigen::Array2d low;
  Eigen::Array2d high;

  double cells() const { return (high - low + 1.0).prod(); }
  /// Whether a grid of this box can be made, and its cells be numbered.
  bool is_sane(std::size_t max_cells) const {
    constexpr double kFarthest = 1e9;
    return cells() <= static_cast<double>(max_cells) && (low.abs() < kFarthest).all() &&
           (high.abs() < kFarthest).all();
  }
  bool holds(const CellBox& other) const { return (low <= other.low).all() && (high >= other.high).all(); }
};

CellBox box_of(const GridGeometry& geometry) {
  const Eigen::Array2d low = (geometry.map_T_grid.position() / geometry.resolution_m).array().round();
  return {low, low + Eigen::Array2d(geometry.columns, geometry.rows) - 1.0};
}

GridGeometry geometry_of(const CellBox& box, double resolution_m) {
  const Eigen::Array2i size = (box.high - box.low + 1.0).cast<int>();
  const Eigen::Vector2d corner_m = box.low.matrix() * resolution_m;
  return {.resolution_m = resolution_m,
          .columns = size.x(),
          .rows = size.y(),
          .map_T_grid = {corner_m.x(), corner_m.y(), 0}};
}

/// The cells that a scan's beams touch, none farther than `max_range_m` along its beam.
CellBox reach_of(const std::vector<BeamReturn>& returns, const Pose2& map_T_base, double max_range_m,
                 double resolution_m) {
  const Eigen::Array2d base_m = map_T_base.position().array();
  CellBox reach_m{base_m, base_m};
  for (const BeamReturn& r : returns) {
    const Eigen::Vector2d beam_m = r.point_m - r.origin_m;
    const Eigen::Vector2d end_m = r.origin_m + std::min(1.0, max_range_m / beam_m.norm()) * beam_m;
    for (const Eigen::Vector2d& p : {r.origin_m, end_m}) {
      const Eigen::Array2d map_point_m = (map_T_base * p).array();
      reach_m = {reach_m.low.min(map_point_m), reach_m.high.max(map_point_m)};
    }
  }
  return {(reach_m.low / resolution_m).floor(), (reach_m.high / resolution_m).floor()};
}

/// Room for both, and on the sides that grow half the size more, so that growing stays rare.
CellBox grown(const CellBox& old, const CellBox& needed) {
  const Eigen::Array2d margin = ((old.high - old.low) / 2).floor();
  CellBox box = old;
  for (int axis = 0; axis < 2; ++axis) {
    if (needed.low[axis] < old.low[axis]) box.low[axis] = needed.low[axis] - margin[axis];
    if (needed.high[axis] > old.high[axis]) box.high[axis] = needed.high[axis] + margin[axis];
  }
  return box;
}

/// The smallest box around the cells that hold any belief; nothing when none does.
CellBox touched(const LogOddsGrid& drawn) {
  const GridGeometry& geometry = drawn.geometry();
  Eigen::Array2d low(geometry.columns, geometry.rows), high(-1, -1);
  for (std::size_t i = 0; i < geometry.size(); ++i) {
    if (drawn.values().values()[i] == 0.0F) continue;
    const Eigen::Array2d cell(geometry.cell(i).column, geometry.cell(i).row);
    low = low.min(cell), high = high.max(cell);
  }
  const Eigen::Array2d origin = box_of(geometry).low;
  return (high < low).any() ? CellBox{origin, origin - 1.0} : CellBox{origin + low, origin + high};
}

}  // namespace

OccupancyMapper::OccupancyMapper(const MappingOptions& options)
    : options_(options), drawn_(GridGeometry{.resolution_m = options.resolution_m}, options.beams) {}

Result<void> OccupancyMapper::insert(const LaserScan& scan, const Eigen::Isometry3d& base_T_laser,
                                     const Pose2& map_T_base, const Pose2& first_T_last) {
  if (!map_T_base.is_finite())
    return Error("the pose of a scan is not finite; mapping needs a known pose for each scan");
  const std::vector<BeamReturn> returns = beam_returns(scan, base_T_laser, first_T_last);
  if (returns.empty()) return {};
  const CellBox needed = reach_of(returns, map_T_base, options_.beams.max_range_m, options_.resolution_m);
  const bool is_first = drawn_.geometry().size() == 0;
  if (is_first || !box_of(drawn_.geometry()).holds(needed)) {
    const CellBox box = is_first ? needed : grown(box_of(drawn_.geometry()), needed);
    if (!box.is_sane(options_.max_cells)) {
      return Error(fmt::format(
          "a scan at ({:g}, {:g}) m would make the map {:.3g} cells large, more than {}; check the poses, "
          "or choose a larger cell or limit",
          map_T_base.x, map_T_base.y, box.cells(), options_.max_cells));
    }
    drawn_ = drawn_.moved_to(geometry_of(box, options_.resolution_m));
  }
  drawn_.draw(returns, map_T_base);
  return {};
}

OccupancyGrid OccupancyMapper::grid() const {
  return drawn_.moved_to(geometry_of(touched(drawn_), options_.resolution_m))
      .occupancy(options_.occupied_probability, options_.free_probability);
}

}  // namespace mstsl
