#include "mstsl/eval/statistics.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace mstsl {
namespace {

TEST(WilsonInterval, HasThePublishedValues) {
  // Newcombe (1998), Statistics in Medicine 17:857, table I, method 3.
  const struct {
    Rate rate;
    double low, high;
  } published[] = {{{81, 263}, 0.2553, 0.3662},
                   {{15, 148}, 0.0624, 0.1605},
                   {{0, 20}, 0.0, 0.1611},
                   {{1, 29}, 0.0061, 0.1718}};
  for (const auto& row : published) {
    const Interval interval = wilson_interval(row.rate);
    EXPECT_NEAR(interval.low, row.low, 5e-5) << row.rate.hits << " of " << row.rate.of;
    EXPECT_NEAR(interval.high, row.high, 5e-5) << row.rate.hits << " of " << row.rate.of;
  }
}

TEST(WilsonInterval, KnowsNothingWithoutTrials) {
  EXPECT_EQ(wilson_interval({}).low, 0.0);
  EXPECT_EQ(wilson_interval({}).high, 1.0);
}

TEST(Quantile, InterpolatesBetweenOrderStatistics) {
  EXPECT_DOUBLE_EQ(quantile({3, 1, 2, 4}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({3, 1, 2}, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile({3, 1, 2}, 1.0), 3.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(SpreadOf, SumsUpAndHasNoFiguresForNoValues) {
  const Spread spread = spread_of({1.0, 2.0, 6.0});
  EXPECT_DOUBLE_EQ(spread.mean, 3.0);
  EXPECT_DOUBLE_EQ(spread.standard_deviation, std::sqrt(7.0));
  EXPECT_DOUBLE_EQ(spread.median, 2.0);
  EXPECT_DOUBLE_EQ(spread.max, 6.0);
  EXPECT_TRUE(std::isnan(spread_of({}).mean));
}

TEST(CumulativeShare, CountsMissingValuesAsBeyondEveryLimit) {
  const auto shares = cumulative_share({0.1, 0.3, 0.7}, {0.05, 0.3, 10.0}, 4);
  EXPECT_EQ(shares, (std::vector<double>{0.0, 0.5, 0.75}));
}

}  // namespace
}  // namespace mstsl
