#include "mstsl/viz/field_sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "map_layers.hpp"
#include "theme.hpp"

namespace mstsl::viz {
namespace {

constexpr double kMargin_px = 36.0, kGap_px = 28.0, kHeader_px = 56.0, kFooter_px = 82.0;
constexpr int kPanels = 6;
constexpr Color kSupported = Color::hex(0x9ecae1), kUnsupported = Color::hex(0xfdd0a2),
                kLine = Color::hex(0x084594);

constexpr std::array<FieldQuantity, 5> kQuantities{FieldQuantity::kX, FieldQuantity::kY, FieldQuantity::kZ,
                                                   FieldQuantity::kNorm, FieldQuantity::kDeviation};

/// Where panels lie on the sheet; all show the same piece of the map.
struct Layout {
  Eigen::AlignedBox2d content_m;
  int columns;
  double width_px, panel_width_px, panel_height_px;

  Layout(const OccupancyGrid& map, double sheet_px) : content_m(known_extent(map)), width_px(sheet_px) {
    constexpr double kTallest = 1.6, kFlattest = 0.2;  // a corridor's map is a stripe
    const Eigen::Vector2d size_m = content_m.sizes();
    const double height_a_width = std::clamp(size_m.y() / std::max(size_m.x(), 1e-3), kFlattest, kTallest);
    columns = height_a_width < 0.5 ? 2 : 3;
    panel_width_px = (width_px - 2 * kMargin_px - (columns - 1) * kGap_px) / columns;
    panel_height_px = panel_width_px * height_a_width;
  }
  double height_px() const {
    return kMargin_px + kHeader_px + kPanels / columns * (panel_height_px + kFooter_px) + kGap_px;
  }
  Eigen::AlignedBox2d panel(int i) const {
    const Eigen::Vector2d corner(kMargin_px + (i % columns) * (panel_width_px + kGap_px),
                                 kMargin_px + kHeader_px + (i / columns) * (panel_height_px + kFooter_px));
    return {corner, Eigen::Vector2d(corner + Eigen::Vector2d(panel_width_px, panel_height_px))};
  }
};

Raster coverage_raster(const FieldMap& field) {
  Raster raster{field.geometry.columns, field.geometry.rows, {}};
  for (std::size_t i = 0; i < field.geometry.size(); ++i) {
    const bool valued = field.mean_uT[i].allFinite();
    raster.pixels.push_back(!valued ? 0 : to_pixel(field.supported[i] != 0 ? kSupported : kUnsupported));
  }
  return raster;
}

void draw_panel(Canvas& canvas, const OccupancyGrid& map, const FieldMap& field, const Layout& layout, int i,
                const Raster& colors) {
  const Eigen::AlignedBox2d frame = layout.panel(i);
  const MapView view(layout.content_m, frame);
  canvas.clip(frame);
  canvas.rectangle(frame, theme::kUnknown);
  draw_map(canvas, view, map, colors, field.geometry);
  if (i == static_cast<int>(kQuantities.size()))
    for (const Fingerprint& f : field.fingerprints) canvas.disc(view.to_px(f.position_m), 0.8, kLine);
  if (i == 0) draw_scale_bar(canvas, view, frame, 100.0);
  canvas.end_clip();
  canvas.outline(frame, {theme::kHairline, 1.5, {}});
}

void draw_coverage_legend(Canvas& canvas, Eigen::Vector2d at) {
  for (const auto& [color, words] :
       {std::pair{kSupported, "a fingerprint is near"}, std::pair{kUnsupported, "none is: a guess"},
        std::pair{kLine, "survey"}}) {
    canvas.rectangle({at, Eigen::Vector2d(at + Eigen::Vector2d(14.0, 14.0))}, color, 2.0);
    canvas.text(at + Eigen::Vector2d(20.0, 13.0), words, {.size = 15.0, .color = theme::kInk});
    at.x() += 44.0 + canvas.text_width(words, {.size = 15.0});
  }
}

}  // namespace

Canvas draw_field(const OccupancyGrid& map, const FieldMap& field, const std::string& title,
                  double width_px) {
  const Layout layout(map, width_px);
  Canvas canvas(width_px, std::ceil(layout.height_px()), theme::kPaper);
  canvas.text({kMargin_px, kMargin_px + 24.0}, title, {.size = 26.0, .color = theme::kInk, .bold = true});
  const auto below = [&](int i) -> Eigen::Vector2d {
    return {layout.panel(i).min().x(), layout.panel(i).max().y() + 6.0};
  };
  for (int i = 0; i < static_cast<int>(kQuantities.size()); ++i) {
    const FieldQuantity quantity = kQuantities[static_cast<std::size_t>(i)];
    const ValueRange range = shown_range(field, map, quantity);
    draw_panel(canvas, map, field, layout, i, field_raster(field, map, quantity, range));
    draw_color_bar(canvas, below(i), layout.panel_width_px * 0.6, quantity_name(quantity), range);
  }
  const int last = static_cast<int>(kQuantities.size());
  draw_panel(canvas, map, field, layout, last, coverage_raster(field));
  draw_coverage_legend(canvas, below(last) + Eigen::Vector2d(0.0, 6.0));
  return canvas;
}

}  // namespace mstsl::viz
