#include "mstsl/viz/plot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plot_frame.hpp"
#include "theme.hpp"

namespace mstsl::viz {
namespace {

bool is_finite(const Eigen::Vector2d& point) { return point.allFinite(); }

std::vector<double> finite(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  return values;
}

template <typename Named>
std::vector<std::string> names_of(const std::vector<Named>& items) {
  std::vector<std::string> names;
  for (const Named& item : items) names.push_back(item.name);
  return names;
}

/// The corners of a staircase that keeps each y until the next x.
Points stairs(const Points& points) {
  Points corners;
  for (const Eigen::Vector2d& point : points) {
    if (!corners.empty()) corners.emplace_back(point.x(), corners.back().y());
    corners.push_back(point);
  }
  return corners;
}

void draw_series(Canvas& canvas, const PlotFrame& frame, const Series& series, const Color& color) {
  Points points;
  std::copy_if(series.points.begin(), series.points.end(), std::back_inserter(points), is_finite);
  if (series.kind == SeriesKind::kStep && !points.empty()) {
    points.emplace_back(std::max(points.back().x(), frame.x_range().high),
                        points.back().y());  // it stays as it ended
    points = stairs(points);
  }
  for (Eigen::Vector2d& point : points) point = frame.to_px(point.x(), point.y());
  if (series.kind != SeriesKind::kPoints) canvas.polyline(points, {color, 2.6, {}});
  if (series.kind == SeriesKind::kPoints)
    for (const Eigen::Vector2d& point : points) canvas.disc(point, 4.0, color.with_alpha(0.8));
}

void draw_threshold(Canvas& canvas, const PlotFrame& frame, const Threshold& threshold) {
  const double x = frame.to_px(threshold.x, 0.0).x();
  canvas.polyline({{x, frame.box().min().y()}, {x, frame.box().max().y()}},
                  {theme::kFaintInk, 1.5, {6.0, 5.0}});
  canvas.text({x - 6.0, frame.box().max().y() - 10.0}, threshold.label,
              {.size = 13.0, .color = theme::kFaintInk, .upwards = true});
}

/// The value below which a share of sorted values lies, linear between neighbours.
double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (at - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

void draw_box(Canvas& canvas, const PlotFrame& frame, double x, std::vector<double> values,
              const Color& color) {
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  constexpr double kHalf = 0.27;
  const double lower = quantile(values, 0.25);
  const double upper = quantile(values, 0.75);
  const double reach = 1.5 * (upper - lower);
  const double from =
      *std::find_if(values.begin(), values.end(), [&](double v) { return v >= lower - reach; });
  const double to =
      *std::find_if(values.rbegin(), values.rend(), [&](double v) { return v <= upper + reach; });
  const auto line = [&](double x0, double y0, double x1, double y1, double width) {
    canvas.polyline({frame.to_px(x0, y0), frame.to_px(x1, y1)}, {theme::kInk, width, {}});
  };
  line(x, from, x, lower, 1.5);
  line(x, upper, x, to, 1.5);
  line(x - kHalf / 2, from, x + kHalf / 2, from, 1.5);
  line(x - kHalf / 2, to, x + kHalf / 2, to, 1.5);
  const Eigen::AlignedBox2d box(frame.to_px(x - kHalf, upper), frame.to_px(x + kHalf, lower));
  canvas.rectangle(box, color.with_alpha(0.55));
  canvas.outline(box, {theme::kInk, 1.5, {}});
  const double median = quantile(values, 0.5);
  line(x - kHalf, median, x + kHalf, median, 3.0);
  for (const double value : values)
    if (value < from || value > to) canvas.circle(frame.to_px(x, value), 3.5, {theme::kInk, 1.2, {}});
}

}  // namespace

Canvas draw_plot(const CurvePlot& plot, PlotSize size) {
  Canvas canvas(size.width_px, size.height_px, theme::kPaper);
  PlotFrame frame(canvas, plot.title, names_of(plot.series));
  std::vector<double> xs;
  std::vector<double> ys;
  for (const Series& series : plot.series)
    for (const Eigen::Vector2d& point : series.points) {
      xs.push_back(point.x());
      ys.push_back(point.y());
    }
  frame.set_x(plot.x, range_of(plot.x, finite(xs)));
  frame.set_y(plot.y, range_of(plot.y, finite(ys)));
  canvas.clip({frame.box().min().array() - 3.0, frame.box().max().array() + 3.0});
  for (const Threshold& threshold : plot.thresholds) draw_threshold(canvas, frame, threshold);
  for (std::size_t i = 0; i < plot.series.size(); ++i) draw_series(canvas, frame, plot.series[i], palette(i));
  canvas.end_clip();
  return canvas;
}

Canvas draw_plot(const BoxPlot& plot, PlotSize size) {
  Canvas canvas(size.width_px, size.height_px, theme::kPaper);
  PlotFrame frame(canvas, plot.title, {});
  std::vector<double> all;
  for (const Group& group : plot.groups) all.insert(all.end(), group.values.begin(), group.values.end());
  frame.set_x(names_of(plot.groups), "");
  frame.set_y(plot.y, range_of(plot.y, finite(all)));
  for (std::size_t i = 0; i < plot.groups.size(); ++i)
    draw_box(canvas, frame, static_cast<double>(i), finite(plot.groups[i].values), palette(i));
  return canvas;
}

Canvas draw_plot(const BarPlot& plot, PlotSize size) {
  Canvas canvas(size.width_px, size.height_px, theme::kPaper);
  PlotFrame frame(canvas, plot.title, names_of(plot.groups));
  std::vector<double> all{0.0};
  for (const Group& group : plot.groups) all.insert(all.end(), group.values.begin(), group.values.end());
  frame.set_x(plot.categories, plot.x_label);
  frame.set_y(plot.y, range_of(plot.y, finite(all)));
  constexpr double kShare = 0.78;  // of a category's width that bars fill
  const double width = kShare / std::max<double>(1.0, static_cast<double>(plot.groups.size()));
  for (std::size_t g = 0; g < plot.groups.size(); ++g)
    for (std::size_t i = 0; i < std::min(plot.categories.size(), plot.groups[g].values.size()); ++i) {
      const double x = static_cast<double>(i) - kShare / 2 + width * static_cast<double>(g);
      const double value = plot.groups[g].values[i];
      if (!std::isfinite(value)) continue;
      Eigen::AlignedBox2d bar;
      bar.extend(frame.to_px(x + 0.04 * width, 0.0));
      bar.extend(frame.to_px(x + 0.96 * width, value));
      canvas.rectangle(bar, palette(g));
      if (i >= plot.groups[g].bounds.size()) continue;
      const auto [low, high] = plot.groups[g].bounds[i];
      const double middle = x + 0.5 * width, half = 0.12 * width;
      for (const auto& [from, to] :
           {std::pair{Eigen::Vector2d(middle, low), Eigen::Vector2d(middle, high)},
            {Eigen::Vector2d(middle - half, low), Eigen::Vector2d(middle + half, low)},
            {Eigen::Vector2d(middle - half, high), Eigen::Vector2d(middle + half, high)}})
        canvas.polyline({frame.to_px(from.x(), from.y()), frame.to_px(to.x(), to.y())},
                        {theme::kInk, 1.5, {}});
    }
  return canvas;
}

Series distribution(const std::string& name, std::vector<double> values, std::size_t total) {
  values = finite(std::move(values));
  std::sort(values.begin(), values.end());
  Series series{name, {}, SeriesKind::kStep};
  if (values.empty()) return series;
  series.points.emplace_back(std::min(0.0, values.front()), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i)
    series.points.emplace_back(
        values[i], static_cast<double>(i + 1) / static_cast<double>(std::max(total, values.size())));
  return series;
}

}  // namespace mstsl::viz
