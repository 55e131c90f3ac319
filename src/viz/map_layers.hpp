#pragma once

#include <string>

#include <Eigen/Geometry>

#include "mstsl/viz/canvas.hpp"
#include "mstsl/viz/picture.hpp"

#include "map_raster.hpp"
#include "map_view.hpp"

/// What pictures of maps share.
namespace mstsl::viz {

/// Floor, a raster of a grid's cells over it (or an empty one), walls.
void draw_map(Canvas& canvas, const MapView& view, const OccupancyGrid& map, const Raster& over_floor,
              const GridGeometry& over_floor_grid);

/// A bar of a round length in m, about `length_px` long, in the lower right corner of a frame.
void draw_scale_bar(Canvas& canvas, const MapView& view, const Eigen::AlignedBox2d& frame, double length_px);

/// What the colours mean, from a point downwards.
void draw_color_bar(Canvas& canvas, const Eigen::Vector2d& at, double width_px, const std::string& label,
                    const ValueRange& range);

std::string quantity_name(FieldQuantity quantity);

}  // namespace mstsl::viz
