#include "mstsl/viz/places_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "map_layers.hpp"
#include "map_view.hpp"
#include "theme.hpp"

namespace mstsl::viz {

Canvas draw_places(const OccupancyGrid& map, const std::vector<PlaceMark>& places, double spacing_m,
                   const std::string& title, const std::string& subtitle, const std::string& label,
                   double width_px) {
  constexpr double kMargin = 36.0, kHeader = 72.0, kFooter = 92.0, kMaxMapHeight = 1300.0, kBarWidth = 330.0;
  Eigen::AlignedBox2d extent_m = known_extent(map);
  const double air_m = 0.02 * extent_m.sizes().maxCoeff();
  extent_m = {extent_m.min().array() - air_m, extent_m.max().array() + air_m};
  const double map_width = width_px - 2.0 * kMargin;
  const double map_height = std::clamp(
      map_width * extent_m.sizes().y() / std::max(extent_m.sizes().x(), 1e-3), 200.0, kMaxMapHeight);
  const double top = kMargin + kHeader;
  const Eigen::AlignedBox2d frame(Eigen::Vector2d(kMargin, top),
                                  Eigen::Vector2d(kMargin + map_width, top + map_height));
  Canvas canvas(width_px, std::ceil(top + map_height + kFooter + kMargin / 2), theme::kPaper);
  const MapView view(extent_m, frame);
  canvas.text({kMargin, kMargin + 24.0}, title, {.size = 28.0, .color = theme::kInk, .bold = true});
  canvas.text({kMargin, kMargin + 54.0}, subtitle, {.size = 18.0, .color = theme::kFaintInk});
  canvas.clip(frame);
  canvas.rectangle(frame, theme::kUnknown);
  draw_map(canvas, view, map, {}, map.geometry());
  const double radius_px = std::max(1.5, 0.42 * spacing_m * view.px_per_m());
  for (const PlaceMark& mark : places) {
    canvas.disc(view.to_px(mark.place_m), radius_px, viridis(mark.share));
    if (mark.warning)
      canvas.circle(view.to_px(mark.place_m), radius_px, {theme::kEstimate, 0.35 * radius_px, {}});
  }
  draw_scale_bar(canvas, view, frame, 200.0);
  canvas.end_clip();
  canvas.outline(frame, {theme::kHairline, 1.5, {}});
  draw_color_bar(canvas, {kMargin, frame.max().y() + 18.0}, kBarWidth, label, {0.0, 100.0});
  return canvas;
}

}  // namespace mstsl::viz
