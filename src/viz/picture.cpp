#include "mstsl/viz/picture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "legend.hpp"
#include "map_layers.hpp"
#include "map_raster.hpp"
#include "map_view.hpp"
#include "marks.hpp"
#include "theme.hpp"

namespace mstsl::viz {
namespace {

constexpr double kMargin = 36.0;
constexpr double kFooter = 92.0;
constexpr double kMaxMapHeight = 1300.0;
constexpr double kBarWidth_px = 330.0;

double header_height(const RunPicture& run) {
  return (run.title.empty() ? 0.0 : 44.0) + (run.subtitle.empty() ? 0.0 : 28.0);
}

/// What must be on the sheet, with a little air around it.
Eigen::AlignedBox2d content(const OccupancyGrid& map, const RunPicture& run) {
  Eigen::AlignedBox2d box = known_extent(map);
  for (const auto* path : {&run.true_path, &run.estimated_path})
    for (const Pose2& pose : *path) box.extend(pose.position());
  for (const HypothesisMark& mark : run.hypotheses) box.extend(mark.map_T_base.position());
  for (const PlaceLabel& place : run.places) box.extend(place.place_m);
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

void draw_run_over(Canvas& canvas, const MapView& view, const RunPicture& run) {
  for (const Eigen::Vector2d& point : run.scan_points_m) draw_scan_point(canvas, view.to_px(point));
  draw_true_path(canvas, view, run.true_path);
  draw_estimated_path(canvas, view, run.estimated_path);
  draw_hypotheses(canvas, view, run.hypotheses);
  for (const PlaceLabel& place : run.places) draw_place(canvas, view.to_px(place.place_m), place.words);
  if (run.start) draw_start(canvas, view.to_px(run.start->position()), -run.start->yaw);
  if (!run.estimated_path.empty()) {
    const Pose2& end = run.estimated_path.back();
    draw_robot(canvas, view.to_px(end.position()), -end.yaw);
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
  draw_map(canvas, view, map,
           run.field != nullptr ? field_raster(*run.field, map, run.quantity, range) : Raster{},
           run.field != nullptr ? run.field->geometry : map.geometry());
  draw_run_over(canvas, view, run);
  draw_scale_bar(canvas, view, frame, 200.0);
  canvas.end_clip();
  canvas.outline(frame, {theme::kHairline, 1.5, {}});
  const Eigen::Vector2d footer(kMargin, frame.max().y() + 18.0);
  if (run.field != nullptr) draw_color_bar(canvas, footer, kBarWidth_px, quantity_name(run.quantity), range);
  draw_legend(canvas, run,
              {Eigen::Vector2d(kMargin + (run.field != nullptr ? kBarWidth_px + 60.0 : 0.0), footer.y()),
               Eigen::Vector2d(kMargin + map_width, canvas.height())});
  return canvas;
}

}  // namespace mstsl::viz
