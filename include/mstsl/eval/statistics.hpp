#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace mstsl {

/// So many of so many.
struct Rate {
  std::size_t hits = 0;
  std::size_t of = 0;

  void add(bool hit) { hits += hit ? 1 : 0, ++of; }
  double share() const { return of == 0 ? 0.0 : static_cast<double>(hits) / static_cast<double>(of); }
};

struct Interval {
  double low = 0.0;
  double high = 1.0;
};

/// Wilson's score interval of a rate (Wilson 1927) at 95 %: honest for few trials and near 0 and 1, where the
/// usual normal interval is not. [0, 1] without trials.
Interval wilson_interval(const Rate& rate);

/// The value that the share `q` in [0, 1] of the values lies at or below, linear between order statistics;
/// NaN without values.
double quantile(std::vector<double> values, double q);

/// How a set of values is spread; all NaN without values.
struct Spread {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::size_t count = 0;
  double mean = kNone;
  double standard_deviation = kNone;  ///< of the sample (n - 1); 0 for one value
  double min = kNone;
  double median = kNone;
  double p90 = kNone;
  double max = kNone;
};
Spread spread_of(const std::vector<double>& values);

/// The share of the values at or below each limit: a cumulative distribution function, read off. `of` is how
/// many there should be: those that are missing (runs without an answer) lie beyond every limit.
std::vector<double> cumulative_share(const std::vector<double>& values, const std::vector<double>& limits,
                                     std::size_t of);

}  // namespace mstsl
