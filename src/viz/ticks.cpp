#include "ticks.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace mstsl::viz {

double nice_step(double span, int count) {
  const double rough = std::max(span, 1e-12) / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double mantissa = rough / power;
  return power * (mantissa < 1.5 ? 1.0 : mantissa < 3.5 ? 2.0 : mantissa < 7.5 ? 5.0 : 10.0);
}

std::vector<double> nice_ticks(double low, double high, int count) {
  const double step = nice_step(high - low, count);
  std::vector<double> ticks;
  const double slack = 1e-9 * step;
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; ++k)
    ticks.push_back(k * step + 0.0);
  return ticks;
}

std::string tick_text(double tick, double step) {
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 9);
  return fmt::format("{:.{}f}", std::abs(tick) < 1e-9 * step ? 0.0 : tick, decimals);
}

}  // namespace mstsl::viz
