#include "marks.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "theme.hpp"

namespace mstsl::viz {
namespace {

constexpr double kJump_m = 1.0;

Eigen::Vector2d along(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// A slim arrow head of the given length around its middle.
Points arrow_head(const Eigen::Vector2d& at, double angle, double length) {
  const Eigen::Vector2d forward = along(angle) * length;
  const Eigen::Vector2d side(-forward.y(), forward.x());
  return {at + 0.55 * forward, at - 0.45 * forward + 0.36 * side, at - 0.25 * forward,
          at - 0.45 * forward - 0.36 * side, at + 0.55 * forward};
}

std::vector<Eigen::Vector2d> positions(std::vector<Pose2>::const_iterator begin,
                                       std::vector<Pose2>::const_iterator end) {
  std::vector<Eigen::Vector2d> points;
  std::transform(begin, end, std::back_inserter(points), [](const Pose2& pose) { return pose.position(); });
  return points;
}

void draw_label(Canvas& canvas, const Eigen::Vector2d& at, const std::string& words) {
  const TextStyle style{.size = 14.0, .color = theme::kInk, .bold = true};
  const double width = canvas.text_width(words, style);
  canvas.rectangle({at + Eigen::Vector2d(-4.0, -14.0), at + Eigen::Vector2d(width + 4.0, 4.0)},
                   theme::kPaper.with_alpha(0.85), 4.0);
  canvas.text(at, words, style);
}

}  // namespace

void draw_scan_point(Canvas& canvas, const Eigen::Vector2d& at) { canvas.disc(at, 1.8, theme::kScan); }

void draw_true_line(Canvas& canvas, const Points& points) {
  canvas.polyline(points, {theme::kPaper, 10.0, {}});
  canvas.polyline(points, {theme::kTruth, 7.0, {}});
}

void draw_estimated_line(Canvas& canvas, const Points& points) {
  canvas.polyline(points, {theme::kEstimate, 3.0, {}});  // seen on the true path's dark band and off it
}

void draw_true_path(Canvas& canvas, const MapView& view, const std::vector<Pose2>& path) {
  if (path.size() > 1) draw_true_line(canvas, view.to_px(positions(path.begin(), path.end())));
}

void draw_estimated_path(Canvas& canvas, const MapView& view, const std::vector<Pose2>& path) {
  for (auto begin = path.begin(); begin != path.end();) {
    const auto jump = std::adjacent_find(
        begin, path.end(), [](const Pose2& a, const Pose2& b) { return distance(a, b) > kJump_m; });
    const auto end = jump == path.end() ? jump : jump + 1;
    draw_estimated_line(canvas, view.to_px(positions(begin, end)));
    begin = end;
  }
}

void draw_hypothesis(Canvas& canvas, const Eigen::Vector2d& at, double angle, double weight, bool rejected) {
  const Points shape = arrow_head(at, angle, rejected ? 20.0 : 28.0);
  if (rejected) {
    canvas.polygon(shape, theme::kPaper.with_alpha(0.9));
    canvas.polyline(shape, {theme::kRejected, 2.2, {}});
    return;
  }
  canvas.polyline(shape, {theme::kPaper, 5.0, {}});
  canvas.polygon(shape, theme::kHypothesis.with_alpha(0.25 + 0.75 * std::clamp(weight, 0.0, 1.0)));
  canvas.polyline(shape, {theme::kHypothesis, 1.5, {}});
}

void draw_hypotheses(Canvas& canvas, const MapView& view, const std::vector<HypothesisMark>& marks) {
  constexpr double kWorthALabel = 0.005;
  double best = 1e-12;
  for (const HypothesisMark& mark : marks) best = std::max(best, mark.rejected ? 0.0 : mark.weight);
  for (const bool rejected : {true, false})  // the surviving ones on top
    for (const HypothesisMark& mark : marks) {
      if (mark.rejected != rejected) continue;
      const Eigen::Vector2d at = view.to_px(mark.map_T_base.position());
      draw_hypothesis(canvas, at, -mark.map_T_base.yaw, mark.weight / best, rejected);
      if (!rejected && mark.weight >= kWorthALabel)
        draw_label(canvas, at + Eigen::Vector2d(18.0, -12.0), fmt::format("{:.0f} %", 100.0 * mark.weight));
    }
}

void draw_place(Canvas& canvas, const Eigen::Vector2d& at, const std::string& words) {
  const TextStyle style{.size = 15.0, .color = theme::kInk, .bold = true};
  const Eigen::Vector2d words_at(at + Eigen::Vector2d(10.0, 5.0));
  const Eigen::Vector2d size(canvas.text_width(words, style), 12.0);
  canvas.rectangle({Eigen::Vector2d(words_at.x() - 2.0, words_at.y() - size.y() - 2.0),
                    Eigen::Vector2d(words_at.x() + size.x() + 2.0, words_at.y() + 3.0)},
                   theme::kPaper.with_alpha(0.8), 3.0);
  canvas.text(words_at, words, style);
  canvas.disc(at, 7.0, theme::kPaper);
  canvas.disc(at, 5.0, theme::kHypothesis);
}

void draw_start(Canvas& canvas, const Eigen::Vector2d& at, double angle) {
  canvas.disc(at, 11.0, theme::kPaper);
  canvas.circle(at, 9.0, {theme::kTruth, 3.0, {}});
  canvas.polyline({at, at + 20.0 * along(angle)}, {theme::kPaper, 6.0, {}});
  canvas.polyline({at, at + 20.0 * along(angle)}, {theme::kTruth, 3.0, {}});
}

void draw_robot(Canvas& canvas, const Eigen::Vector2d& at, double angle) {
  canvas.disc(at, 14.0, theme::kPaper);
  canvas.disc(at, 12.0, theme::kEstimate);
  canvas.polygon(arrow_head(at, angle, 17.0), theme::kPaper);
}

}  // namespace mstsl::viz
