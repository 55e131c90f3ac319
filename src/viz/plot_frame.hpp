#pragma once

#include <string>
#include <vector>

#include "mstsl/viz/canvas.hpp"
#include "mstsl/viz/plot.hpp"

#include "map_raster.hpp"

namespace mstsl::viz {

/// The sheet of a plot: title, legend, axes with ticks and a faint grid, and where data come to lie.
class PlotFrame {
 public:
  PlotFrame(Canvas& canvas, const std::string& title, const std::vector<std::string>& legend);

  /// Axes of numbers, or of categories each one wide and centred on 0, 1, 2, ...
  void set_x(const Axis& axis, const ValueRange& range);
  void set_x(const std::vector<std::string>& categories, const std::string& label);
  void set_y(const Axis& axis, const ValueRange& range);

  Eigen::Vector2d to_px(double x, double y) const;
  const Eigen::AlignedBox2d& box() const { return box_; }
  const ValueRange& x_range() const { return x_; }

 private:
  void draw_legend(const std::vector<std::string>& legend, double y);

  Canvas& canvas_;
  Eigen::AlignedBox2d box_;
  ValueRange x_;
  ValueRange y_;
};

/// From the least to the greatest of `values` (which may be none), with the axis' own bounds in their place.
ValueRange range_of(const Axis& axis, const std::vector<double>& values);

}  // namespace mstsl::viz
