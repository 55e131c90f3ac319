#pragma once

#include <Eigen/Geometry>

#include "mstsl/grid/geometry.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/viz/canvas.hpp"

namespace mstsl::viz {

/// How the map lies on the sheet: metres to px, north up.
class MapView {
 public:
  /// Shows `content_m` (map frame) as large as fits into `frame` (px), centred.
  MapView(const Eigen::AlignedBox2d& content_m, const Eigen::AlignedBox2d& frame);

  double px_per_m() const { return px_per_m_; }
  Eigen::Vector2d to_px(const Eigen::Vector2d& map_point_m) const;
  Points to_px(const std::vector<Eigen::Vector2d>& map_points_m) const;
  /// For a raster whose pixel (column, row) covers `cells` x `cells` cells of a grid, row 0 first.
  Eigen::Affine2d canvas_T_raster(const GridGeometry& grid, int cells) const;

 private:
  double px_per_m_;
  Eigen::Vector2d map_origin_px_;
};

/// The rectangle of the map frame that holds every cell that is free or occupied; the whole grid where there
/// is none.
Eigen::AlignedBox2d known_extent(const OccupancyGrid& map);

}  // namespace mstsl::viz
