#include "legend.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "marks.hpp"
#include "theme.hpp"

namespace mstsl::viz {
namespace {

constexpr double kSwatch = 44.0;
constexpr double kRow = 34.0;
constexpr double kGap = 34.0;

struct Entry {
  std::string words;
  std::function<void(Canvas&, const Eigen::Vector2d&)> draw;  ///< around the middle of its swatch
};

void draw_line(Canvas& canvas, const Eigen::Vector2d& at, void (*line)(Canvas&, const Points&)) {
  line(canvas, {at - Eigen::Vector2d(18, 0), at + Eigen::Vector2d(18, 0)});
}

std::vector<Entry> entries(const RunPicture& run) {
  const auto any = [&](bool rejected) {
    return std::any_of(run.hypotheses.begin(), run.hypotheses.end(),
                       [=](const auto& mark) { return mark.rejected == rejected; });
  };
  std::vector<Entry> all;
  if (run.true_path.size() > 1)
    all.push_back({"true path", [](auto& c, const auto& at) { draw_line(c, at, draw_true_line); }});
  if (run.start)
    all.push_back({"start", [](auto& c, const auto& at) { draw_start(c, at - Eigen::Vector2d(5, 0), 0.0); }});
  if (run.estimated_path.size() > 1)
    all.push_back({"estimated path", [](auto& c, const auto& at) { draw_line(c, at, draw_estimated_line); }});
  if (!run.estimated_path.empty())
    all.push_back({"answer", [](auto& c, const auto& at) { draw_robot(c, at, 0.0); }});
  if (any(false))
    all.push_back({"hypothesis, with its weight",
                   [](auto& c, const auto& at) { draw_hypothesis(c, at, 0.0, 1.0, false); }});
  if (any(true))
    all.push_back({"rejected", [](auto& c, const auto& at) { draw_hypothesis(c, at, 0.0, 0.0, true); }});
  if (!run.scan_points_m.empty())
    all.push_back({"LiDAR points", [](auto& c, const auto& at) {
                     for (const double dx : {-14.0, -9.5, -5.0, -0.5, 4.0, 8.5, 13.0})
                       draw_scan_point(c, at + Eigen::Vector2d(dx, 0.12 * dx));
                   }});
  return all;
}

}  // namespace

void draw_legend(Canvas& canvas, const RunPicture& run, const Eigen::AlignedBox2d& frame) {
  const TextStyle style{.size = 16.0, .color = theme::kInk};
  Eigen::Vector2d at(frame.min().x(), frame.min().y() + 12.0);
  for (const Entry& entry : entries(run)) {
    const double width = kSwatch + 10.0 + canvas.text_width(entry.words, style);
    if (at.x() > frame.min().x() && at.x() + width > frame.max().x()) at = {frame.min().x(), at.y() + kRow};
    entry.draw(canvas, at + Eigen::Vector2d(kSwatch / 2, 0.0));
    canvas.text(at + Eigen::Vector2d(kSwatch + 10.0, 6.0), entry.words, style);
    at.x() += width + kGap;
  }
}

}  // namespace mstsl::viz
