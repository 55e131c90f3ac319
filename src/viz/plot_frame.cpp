#include "plot_frame.hpp"

#include <algorithm>
#include <cmath>

#include "theme.hpp"
#include "ticks.hpp"

namespace mstsl::viz {
namespace {

constexpr double kLeft = 86.0;
constexpr double kRight = 28.0;
constexpr double kTop = 24.0;
constexpr double kBottom = 70.0;
constexpr TextStyle kTick{.size = 14.0, .color = theme::kFaintInk, .anchor = Anchor::kMiddle};
constexpr TextStyle kLabel{.size = 15.0, .color = theme::kInk, .anchor = Anchor::kMiddle};

}  // namespace

PlotFrame::PlotFrame(Canvas& canvas, const std::string& title, const std::vector<std::string>& legend)
    : canvas_(canvas) {
  double y = kTop;
  if (!title.empty()) {
    y += 20.0;
    canvas.text({kLeft, y}, title, {.size = 20.0, .color = theme::kInk, .bold = true});
    y += 12.0;
  }
  if (legend.size() > 1) {
    y += 16.0;
    draw_legend(legend, y);
    y += 12.0;
  }
  box_ = {Eigen::Vector2d(kLeft, y + 6.0),
          Eigen::Vector2d(canvas.width() - kRight, canvas.height() - kBottom)};
}

void PlotFrame::draw_legend(const std::vector<std::string>& legend, double y) {
  const TextStyle style{.size = 14.0, .color = theme::kInk};
  double x = kLeft;
  for (std::size_t i = 0; i < legend.size(); ++i) {
    canvas_.rectangle({Eigen::Vector2d(x, y - 9.0), Eigen::Vector2d(x + 20.0, y - 3.0)}, palette(i), 3.0);
    canvas_.text({x + 28.0, y}, legend[i], style);
    x += 28.0 + canvas_.text_width(legend[i], style) + 26.0;
  }
}

void PlotFrame::set_x(const Axis& axis, const ValueRange& range) {
  x_ = range;
  const double step = nice_step(range.high - range.low, 8);
  for (const double tick : nice_ticks(range.low, range.high, 8)) {
    const double x = to_px(tick, 0.0).x();
    canvas_.polyline({{x, box_.min().y()}, {x, box_.max().y()}}, {theme::kHairline, 1.0, {}});
    canvas_.text({x, box_.max().y() + 20.0}, tick_text(tick, step), kTick);
  }
  canvas_.text({box_.center().x(), box_.max().y() + 48.0}, axis.label, kLabel);
}

void PlotFrame::set_x(const std::vector<std::string>& categories, const std::string& label) {
  x_ = {-0.5, std::max(static_cast<double>(categories.size()), 1.0) - 0.5};
  for (std::size_t i = 0; i < categories.size(); ++i)
    canvas_.text({to_px(static_cast<double>(i), 0.0).x(), box_.max().y() + 22.0}, categories[i], kLabel);
  canvas_.text({box_.center().x(), box_.max().y() + 48.0}, label, kLabel);
}

void PlotFrame::set_y(const Axis& axis, const ValueRange& range) {
  y_ = range;
  const double step = nice_step(range.high - range.low, 6);
  for (const double tick : nice_ticks(range.low, range.high, 6)) {
    const double y = to_px(0.0, tick).y();
    canvas_.polyline({{box_.min().x(), y}, {box_.max().x(), y}}, {theme::kHairline, 1.0, {}});
    TextStyle style = kTick;
    style.anchor = Anchor::kEnd;
    canvas_.text({box_.min().x() - 10.0, y + 5.0}, tick_text(tick, step), style);
  }
  TextStyle style = kLabel;
  style.upwards = true;
  canvas_.text({26.0, box_.center().y()}, axis.label, style);
  canvas_.polyline({box_.corner(Eigen::AlignedBox2d::TopLeft), box_.corner(Eigen::AlignedBox2d::TopRight)},
                   {theme::kFaintInk, 1.5, {}});  // the lower edge, as y points down
}

Eigen::Vector2d PlotFrame::to_px(double x, double y) const {
  return {box_.min().x() + x_.share(x) * box_.sizes().x(), box_.max().y() - y_.share(y) * box_.sizes().y()};
}

ValueRange range_of(const Axis& axis, const std::vector<double>& values) {
  ValueRange range{axis.low.value_or(0.0), axis.high.value_or(1.0)};
  if (!values.empty()) {
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    const double air = 0.04 * (*greatest - *least);
    if (!axis.low) range.low = *least >= 0.0 && *least < 0.5 * *greatest ? 0.0 : *least - air;
    if (!axis.high) range.high = *greatest + air;
  }
  if (!(range.high > range.low)) range.high = range.low + 1.0;
  return range;
}

}  // namespace mstsl::viz
