#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "mstsl/viz/canvas.hpp"

namespace mstsl::viz {

/// An axis; where it begins or ends is taken from the data unless given.
struct Axis {
  std::string label;
  std::optional<double> low;
  std::optional<double> high;
};

enum class SeriesKind { kLine, kStep, kPoints };

struct Series {
  std::string name;
  Points points;  ///< (x, y); those that are not finite are left out
  SeriesKind kind = SeriesKind::kLine;
};

/// A line across the plot at a value of x, such as a bound, with a word to it.
struct Threshold {
  double x = 0.0;
  std::string label;
};

/// Curves over a common x.
struct CurvePlot {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Series> series;
  std::vector<Threshold> thresholds;
};

struct Range {
  double low = 0.0, high = 0.0;
};

struct Group {
  std::string name;
  std::vector<double> values;
  std::vector<Range> bounds = {};  ///< of each value, shown as a whisker on its bar; none if empty
};

/// A box for each group: median, quartiles, whiskers to the farthest value within 1.5 box lengths (Tukey),
/// the rest as points. Values that are not finite are left out.
struct BoxPlot {
  std::string title;
  Axis y;
  std::vector<Group> groups;
};

/// A bar for each category, side by side where there are several groups; groups[i].values has one for each
/// category.
struct BarPlot {
  std::string title;
  std::string x_label;
  Axis y;
  std::vector<std::string> categories;
  std::vector<Group> groups;
};

struct PlotSize {
  double width_px = 900.0;
  double height_px = 560.0;
};

Canvas draw_plot(const CurvePlot& plot, PlotSize size = {});
Canvas draw_plot(const BoxPlot& plot, PlotSize size = {});
Canvas draw_plot(const BarPlot& plot, PlotSize size = {});

/// The empirical distribution of values as a step curve from share 0 upwards. With `total` above the count of
/// finite values (runs that gave no value count as infinite) it ends below 1.
Series distribution(const std::string& name, std::vector<double> values, std::size_t total);

}  // namespace mstsl::viz
