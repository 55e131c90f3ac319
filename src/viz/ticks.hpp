#pragma once

#include <string>
#include <vector>

namespace mstsl::viz {

/// A step of 1, 2 or 5 times a power of ten that cuts `span` into about `count` parts (Heckbert 1990).
double nice_step(double span, int count);

/// The multiples of a nice step within [low, high].
std::vector<double> nice_ticks(double low, double high, int count);

/// The tick's number with as many decimals as its step needs.
std::string tick_text(double tick, double step);

}  // namespace mstsl::viz
