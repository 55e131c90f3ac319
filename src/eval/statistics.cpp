#include "mstsl/eval/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace mstsl {
namespace {

/// `values` sorted and not empty.
double quantile_of_sorted(const std::vector<double>& values, double q) {
  const double place = std::clamp(q, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (place - static_cast<double>(low)) * (values[high] - values[low]);
}

}  // namespace

Interval wilson_interval(const Rate& rate) {
  if (rate.of == 0) return {};
  constexpr double z = 1.959963984540054;  // the 97.5 % point of the normal distribution
  const double n = static_cast<double>(rate.of);
  const double p = rate.share();
  const double center = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  return {rate.hits == 0 ? 0.0 : center - half, rate.hits == rate.of ? 1.0 : center + half};
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return quantile_of_sorted(values, q);
}

Spread spread_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const double n = static_cast<double>(sorted.size());
  const double mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / n;
  double squares = 0.0;
  for (const double value : sorted) squares += (value - mean) * (value - mean);
  const double sd = sorted.size() > 1 ? std::sqrt(squares / (n - 1)) : 0.0;
  return {sorted.size(),
          mean,
          sd,
          sorted.front(),
          quantile_of_sorted(sorted, 0.5),
          quantile_of_sorted(sorted, 0.9),
          sorted.back()};
}

std::vector<double> cumulative_share(const std::vector<double>& values, const std::vector<double>& limits,
                                     std::size_t of) {
  std::vector<double> shares;
  shares.reserve(limits.size());
  for (const double limit : limits) {
    const auto within =
        std::count_if(values.begin(), values.end(), [&](double value) { return value <= limit; });
    shares.push_back(of == 0 ? 0.0 : static_cast<double>(within) / static_cast<double>(of));
  }
  return shares;
}

}  // namespace mstsl
