#include "mstsl/datasets/windows.hpp"

#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

#include "test_support.hpp"

namespace mstsl::datasets {
namespace {

std::vector<Eigen::Vector2d> straight(std::size_t rows, double step_m) {
  std::vector<Eigen::Vector2d> path_m;
  for (std::size_t i = 0; i < rows; ++i) path_m.emplace_back(step_m * static_cast<double>(i), 0.0);
  return path_m;
}

TEST(Windows, AreAsLongAsAskedAndNoRowLonger) {
  const auto path_m = straight(100, 0.25);
  const auto windows = windows_of_length(path_m, std::vector<bool>(100, true), 5.0);
  ASSERT_EQ(windows.size(), 80U);  // rows 0 .. 79 have 20 steps before them
  for (const Window& window : windows) EXPECT_EQ(window.last - window.first, 20U);
}

TEST(Windows, AgreeWithBruteForceOnPathsWithGaps) {
  Random random(4);
  for (int trial = 0; trial < 30; ++trial) {
    std::vector<Eigen::Vector2d> path_m = {{0.0, 0.0}};
    std::vector<bool> follows = {random.chance(0.5)};
    for (int i = 1; i < 60; ++i) {
      path_m.emplace_back(path_m.back() +
                          Eigen::Vector2d(random.uniform(0.0, 1.0), random.uniform(-0.5, 0.5)));
      follows.push_back(random.chance(0.9));
    }
    std::vector<Window> expected;
    for (std::size_t first = 0; first < path_m.size(); ++first) {
      double driven_m = 0.0;
      for (std::size_t last = first + 1; last < path_m.size() && follows[last]; ++last) {
        driven_m += (path_m[last] - path_m[last - 1]).norm();
        if (driven_m < 4.0) continue;
        expected.push_back({first, last});
        break;
      }
    }
    EXPECT_EQ(windows_of_length(path_m, follows, 4.0), expected);
  }
}

TEST(Windows, AreNoneOnAPathTooShort) {
  EXPECT_TRUE(windows_of_length(straight(10, 0.1), std::vector<bool>(10, true), 5.0).empty());
  EXPECT_TRUE(windows_of_length({}, {}, 5.0).empty());
}

TEST(Windows, AreDrawnBySeedAndWithoutRepeat) {
  const auto windows = windows_of_length(straight(100, 0.25), std::vector<bool>(100, true), 5.0);
  const auto drawn = test::must(draw_windows(windows, 80, Random(7)));
  std::set<std::size_t> starts;
  for (const Window& window : drawn) starts.insert(window.first);
  EXPECT_EQ(starts.size(), 80U);
  EXPECT_EQ(drawn, test::must(draw_windows(windows, 80, Random(7))));
  EXPECT_NE(drawn, test::must(draw_windows(windows, 80, Random(8))));
}

TEST(Windows, ThatAreTooFewAreAnError) {
  const auto drawn = draw_windows({{0, 5}}, 2, Random(1));
  ASSERT_FALSE(drawn.ok());
  EXPECT_NE(drawn.error().message().find("only 1"), std::string::npos);
}

TEST(DistancesAlong, AddUpThePathsSteps) {
  const std::vector<Eigen::Vector2d> path_m = {{0, 0}, {3, 4}, {3, 4}, {3, 6}};
  EXPECT_EQ(distances_along(path_m), (std::vector<double>{0, 5, 5, 7}));
}

}  // namespace
}  // namespace mstsl::datasets
