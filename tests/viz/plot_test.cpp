#include "mstsl/viz/plot.hpp"

#include <cmath>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"
#include "mstsl/io/file_bytes.hpp"

#include "../../src/viz/ticks.hpp"
#include "test_support.hpp"

namespace mstsl::viz {
namespace {

using test::must;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Ticks, AreFewRoundAndInside) {
  Random random(1);
  for (int round = 0; round < 1000; ++round) {
    const double low = random.normal(0.0, 100.0);
    const double high = low + std::pow(10.0, random.uniform(-4.0, 5.0));
    const auto ticks = nice_ticks(low, high, 6);
    EXPECT_GE(ticks.size(), 2u);
    EXPECT_LE(ticks.size(), 12u);
    const double step = nice_step(high - low, 6);
    for (const double tick : ticks) {
      EXPECT_GE(tick, low - 1e-6 * step);
      EXPECT_LE(tick, high + 1e-6 * step);
      EXPECT_NEAR(tick / step, std::round(tick / step), 1e-6);
    }
  }
}

TEST(Ticks, AreWrittenWithTheDecimalsTheyNeed) {
  EXPECT_EQ(tick_text(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tick_text(-0.0, 0.1), "0.0");
  EXPECT_EQ(tick_text(20.0, 10.0), "20");
  EXPECT_EQ(tick_text(0.25, 0.05), "0.25");
}

TEST(Distribution, ReachesTheShareOfRunsThatHaveAValue) {
  const Series series = distribution("runs", {0.3, 0.1, kNaN, 0.2, INFINITY}, 5);
  ASSERT_EQ(series.points.size(), 4u);
  EXPECT_EQ(series.points.front(), Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(series.points[1], Eigen::Vector2d(0.1, 0.2));
  EXPECT_EQ(series.points.back(), Eigen::Vector2d(0.3, 0.6));
  EXPECT_TRUE(distribution("none", {kNaN}, 3).points.empty());
}

TEST(Plots, AreDrawnOfAnything) {
  const test::TemporaryFolder folder;
  const auto size_of = [&](const Canvas& canvas) {
    must(canvas.save(folder.path() / "plot.png"));
    return std::filesystem::file_size(folder.path() / "plot.png");
  };
  // What is drawn makes the picture larger than the same one without data.
  const auto curves = [](std::vector<Series> series) {
    return draw_plot(CurvePlot{"t", {"x", 0, 2}, {"y", 0, 5}, series, {}});
  };
  EXPECT_GT(size_of(curves({{"a", {{0, 0}, {kNaN, 1}, {2, 5}}, SeriesKind::kLine}})),
            size_of(curves({{"a", {}, SeriesKind::kLine}})));
  EXPECT_GT(size_of(curves({{"a", {{1, 1}}, SeriesKind::kPoints}})),
            size_of(curves({{"a", {}, SeriesKind::kLine}})));
  const auto boxes = [](std::vector<double> values) {
    return draw_plot(BoxPlot{"t", {"y", 0, 10}, {{"a", values, {}}}});
  };
  EXPECT_GT(size_of(boxes({1, 2, 3, 9, kNaN})), size_of(boxes({})));
  EXPECT_GT(size_of(boxes({7, 7, 7})), size_of(boxes({kNaN})));
  const auto bars = [](std::vector<double> values, std::vector<Range> bounds = {}) {
    return draw_plot(BarPlot{"t", "x", {"y", -5, 5}, {"1", "2"}, {{"a", values, bounds}}});
  };
  EXPECT_GT(size_of(bars({1, -3}, {{0, 2}})), size_of(bars({1, -3})));
  EXPECT_GT(size_of(bars({1, -3})), size_of(bars({kNaN})));
  EXPECT_GT(size_of(draw_plot(CurvePlot{})), 1000u);
}

}  // namespace
}  // namespace mstsl::viz
