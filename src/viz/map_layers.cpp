#include "map_layers.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "theme.hpp"
#include "ticks.hpp"

namespace mstsl::viz {

void draw_map(Canvas& canvas, const MapView& view, const OccupancyGrid& map, const Raster& over_floor,
              const GridGeometry& over_floor_grid) {
  const GridGeometry& g = map.geometry();
  canvas.image(floor_raster(map), view.canvas_T_raster(g, 1));
  canvas.image(over_floor, view.canvas_T_raster(over_floor_grid, 1));
  const int cells_a_px = std::max(1, static_cast<int>(std::ceil(1.0 / (view.px_per_m() * g.resolution_m))));
  canvas.image(wall_raster(map, cells_a_px), view.canvas_T_raster(g, cells_a_px));
}

void draw_scale_bar(Canvas& canvas, const MapView& view, const Eigen::AlignedBox2d& frame, double length_px) {
  const double length_m = nice_step(view.px_per_m() > 0 ? length_px / view.px_per_m() : 1.0, 1);
  const double length = length_m * view.px_per_m();
  const Eigen::Vector2d at(frame.max().x() - 20.0 - length, frame.max().y() - 18.0);
  canvas.rectangle(
      {Eigen::Vector2d(at.x() - 12.0, at.y() - 28.0), Eigen::Vector2d(at.x() + length + 12.0, at.y() + 10.0)},
      theme::kPaper.with_alpha(0.85), 5.0);
  canvas.polyline(
      {at + Eigen::Vector2d(0, -5), at, at + Eigen::Vector2d(length, 0), at + Eigen::Vector2d(length, -5)},
      {theme::kInk, 2.0, {}});
  canvas.text(at + Eigen::Vector2d(length / 2, -9.0), fmt::format("{:g} m", length_m),
              {.size = 15.0, .color = theme::kInk, .anchor = Anchor::kMiddle});
}

std::string quantity_name(FieldQuantity quantity) {
  switch (quantity) {
    case FieldQuantity::kNorm:
      return "magnetic field |B| (µT)";
    case FieldQuantity::kX:
      return "magnetic field Bx (µT)";
    case FieldQuantity::kY:
      return "magnetic field By (µT)";
    case FieldQuantity::kZ:
      return "magnetic field Bz (µT)";
    case FieldQuantity::kDeviation:
      return "standard deviation of the field (µT)";
  }
  return "";
}

void draw_color_bar(Canvas& canvas, const Eigen::Vector2d& at, double width_px, const std::string& label,
                    const ValueRange& range) {
  constexpr double kHeight = 14.0;
  canvas.text({at.x(), at.y() + 14.0}, label, {.size = 16.0, .color = theme::kInk});
  Raster ramp{256, 1, {}};
  for (int i = 0; i < 256; ++i) ramp.pixels.push_back(to_pixel(viridis(i / 255.0)));
  Eigen::Affine2d place = Eigen::Affine2d::Identity();
  place.translate(Eigen::Vector2d(at.x(), at.y() + 24.0)).scale(Eigen::Vector2d(width_px / 256.0, kHeight));
  canvas.image(ramp, place);
  const double step = nice_step(range.high - range.low, 5);
  for (const double tick : nice_ticks(range.low, range.high, 5)) {
    const double x = at.x() + width_px * range.share(tick);
    canvas.polyline({{x, at.y() + 24.0 + kHeight}, {x, at.y() + 24.0 + kHeight + 5.0}},
                    {theme::kFaintInk, 1.5, {}});
    canvas.text({x, at.y() + 24.0 + kHeight + 21.0}, tick_text(tick, step),
                {.size = 14.0, .color = theme::kFaintInk, .anchor = Anchor::kMiddle});
  }
}

}  // namespace mstsl::viz
