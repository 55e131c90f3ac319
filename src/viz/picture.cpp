#include "mstsl/viz/picture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "legend.hpp"
#include "map_raster.hpp"
#include "map_view.hpp"
#include "marks.hpp"
#include "theme.hpp"
#include "ticks.hpp"

namespace mstsl::viz {
namespace {

constexpr double kMargin = 36.0;
constexpr double kFooter = 92.0;
constexpr double kMaxMapHeight = 1300.0;
constexpr double kBarWidth = 330.0;

double header_height(const RunPicture& run) {
  return (run.title.empty() ? 0.0 : 44.0) + (run.subtitle.empty() ? 0.0 : 28.0);
}

/// What must be on the sheet, with a little air around it.
Eigen::AlignedBox2d content(const OccupancyGrid& map, const RunPicture& run) {
  Eigen::AlignedBox2d box = known_extent(map);
  for (const auto* path : {&run.true_path, &run.estimated_path})
    for (const Pose2& pose : *path) box.extend(pose.position());
  for (const HypothesisMark& mark : run.hypotheses) box.extend(mark.map_T_base.position());
  const double air_m = 0.02 * box.sizes().maxCoeff();
  return {box.min().array() - air_m, box.max().array() + air_m};
}

void draw_header(Canvas& canvas, const RunPicture& run) {
  double y = kMargin;
  if (!run.title.empty())
    canvas.text({kMargin, y += 24.0}, run.title, {.size = 28.0, .color = theme::kInk, .bold = true});
  if (!run.subtitle.empty())
    canvas.text({kMargin, y += 30.0}, run.subtitle, {.size = 18.0, .color = theme::kFaintInk});
}

void draw_map(Canvas& canvas, const MapView& view, const OccupancyGrid& map, const RunPicture& run,
              const ValueRange& range) {
  const GridGeometry& g = map.geometry();
  canvas.image(floor_raster(map), view.canvas_T_raster(g, 1));
  if (run.field != nullptr)
    canvas.image(field_raster(*run.field, map, run.quantity, range),
                 view.canvas_T_raster(run.field->geometry, 1));
  const int cells_a_px = std::max(1, static_cast<int>(std::ceil(1.0 / (view.px_per_m() * g.resolution_m))));
  canvas.image(wall_raster(map, cells_a_px), view.canvas_T_raster(g, cells_a_px));
}

void draw_run_over(Canvas& canvas, const MapView& view, const RunPicture& run) {
  for (const Eigen::Vector2d& point : run.scan_points_m) draw_scan_point(canvas, view.to_px(point));
  draw_true_path(canvas, view, run.true_path);
  draw_estimated_path(canvas, view, run.estimated_path);
  draw_hypotheses(canvas, view, run.hypotheses);
  if (run.start) draw_start(canvas, view.to_px(run.start->position()), -run.start->yaw);
  if (!run.estimated_path.empty()) {
    const Pose2& end = run.estimated_path.back();
    draw_robot(canvas, view.to_px(end.position()), -end.yaw);
  }
}

void draw_scale_bar(Canvas& canvas, const MapView& view, const Eigen::AlignedBox2d& frame) {
  const double length_m = nice_step(view.px_per_m() > 0 ? 200.0 / view.px_per_m() : 1.0, 1);
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

void draw_color_bar(Canvas& canvas, const Eigen::Vector2d& at, const RunPicture& run,
                    const ValueRange& range) {
  constexpr double kHeight = 14.0;
  canvas.text({at.x(), at.y() + 14.0}, quantity_name(run.quantity), {.size = 16.0, .color = theme::kInk});
  Raster ramp{256, 1, {}};
  for (int i = 0; i < 256; ++i) ramp.pixels.push_back(to_pixel(viridis(i / 255.0)));
  Eigen::Affine2d place = Eigen::Affine2d::Identity();
  place.translate(Eigen::Vector2d(at.x(), at.y() + 24.0)).scale(Eigen::Vector2d(kBarWidth / 256.0, kHeight));
  canvas.image(ramp, place);
  const double step = nice_step(range.high - range.low, 5);
  for (const double tick : nice_ticks(range.low, range.high, 5)) {
    const double x = at.x() + kBarWidth * range.share(tick);
    canvas.polyline({{x, at.y() + 24.0 + kHeight}, {x, at.y() + 24.0 + kHeight + 5.0}},
                    {theme::kFaintInk, 1.5, {}});
    canvas.text({x, at.y() + 24.0 + kHeight + 21.0}, tick_text(tick, step),
                {.size = 14.0, .color = theme::kFaintInk, .anchor = Anchor::kMiddle});
  }
}

}  // namespace

Canvas draw_run(const OccupancyGrid& map, const RunPicture& run, double width_px) {
  const Eigen::AlignedBox2d extent_m = content(map, run);
  const double map_width = width_px - 2.0 * kMargin;
  const double map_height = std::clamp(
      map_width * extent_m.sizes().y() / std::max(extent_m.sizes().x(), 1e-3), 200.0, kMaxMapHeight);
  const double top = kMargin + header_height(run);
  const Eigen::AlignedBox2d frame(Eigen::Vector2d(kMargin, top),
                                  Eigen::Vector2d(kMargin + map_width, top + map_height));
  Canvas canvas(width_px, std::ceil(top + map_height + kFooter + kMargin / 2), theme::kPaper);
  const MapView view(extent_m, frame);
  const ValueRange range = run.field != nullptr ? shown_range(*run.field, map, run.quantity) : ValueRange{};

  draw_header(canvas, run);
  canvas.clip(frame);
  canvas.rectangle(frame, theme::kUnknown);
  draw_map(canvas, view, map, run, range);
  draw_run_over(canvas, view, run);
  draw_scale_bar(canvas, view, frame);
  canvas.end_clip();
  canvas.outline(frame, {theme::kHairline, 1.5, {}});
  const Eigen::Vector2d footer(kMargin, frame.max().y() + 18.0);
  if (run.field != nullptr) draw_color_bar(canvas, footer, run, range);
  draw_legend(canvas, run,
              {Eigen::Vector2d(kMargin + (run.field != nullptr ? kBarWidth + 60.0 : 0.0), footer.y()),
               Eigen::Vector2d(kMargin + map_width, canvas.height())});
  return canvas;
}

}  // namespace mstsl::viz
