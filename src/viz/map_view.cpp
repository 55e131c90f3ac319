#include "map_view.hpp"

#include <algorithm>

namespace mstsl::viz {

MapView::MapView(const Eigen::AlignedBox2d& content_m, const Eigen::AlignedBox2d& frame)
    : px_per_m_((frame.sizes().array() / content_m.sizes().array().max(1e-3)).minCoeff()),
      map_origin_px_(frame.center() -
                     px_per_m_ * Eigen::Vector2d(content_m.center().x(), -content_m.center().y())) {}

Eigen::Vector2d MapView::to_px(const Eigen::Vector2d& map_point_m) const {
  return map_origin_px_ + px_per_m_ * Eigen::Vector2d(map_point_m.x(), -map_point_m.y());
}

Points MapView::to_px(const std::vector<Eigen::Vector2d>& map_points_m) const {
  Points points(map_points_m.size());
  std::transform(map_points_m.begin(), map_points_m.end(), points.begin(),
                 [this](const Eigen::Vector2d& point) { return to_px(point); });
  return points;
}

Eigen::Affine2d MapView::canvas_T_raster(const GridGeometry& grid, int cells) const {
  Eigen::Affine2d transform = Eigen::Affine2d::Identity();
  transform.translate(map_origin_px_);
  transform.scale(Eigen::Vector2d(px_per_m_, -px_per_m_));
  transform.translate(grid.map_T_grid.position());
  transform.rotate(grid.map_T_grid.yaw);
  transform.scale(grid.resolution_m * cells);
  return transform;
}

Eigen::AlignedBox2d known_extent(const OccupancyGrid& map) {
  const GridGeometry& g = map.geometry();
  Eigen::AlignedBox2d cells;
  for (std::size_t i = 0; i < map.values().size(); ++i) {
    if (map.values()[i] == CellState::kUnknown) continue;
    const Cell cell = g.cell(i);
    cells.extend(Eigen::Vector2d(cell.column, cell.row));
    cells.extend(Eigen::Vector2d(cell.column + 1.0, cell.row + 1.0));
  }
  if (cells.isEmpty())
    cells = Eigen::AlignedBox2d(Eigen::Vector2d::Zero(), Eigen::Vector2d(g.columns, g.rows));
  Eigen::AlignedBox2d extent_m;
  for (const auto corner : {Eigen::AlignedBox2d::BottomLeft, Eigen::AlignedBox2d::BottomRight,
                            Eigen::AlignedBox2d::TopLeft, Eigen::AlignedBox2d::TopRight})
    extent_m.extend(g.to_map(cells.corner(corner)));
  return extent_m;
}

}  // namespace mstsl::viz
