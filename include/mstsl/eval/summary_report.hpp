#pragma once

#include <string>

#include "mstsl/eval/summary.hpp"

namespace mstsl {

/// The summary as a table for people, several lines.
std::string to_text(const Summary& summary);

/// The same as one JSON object (rates with their Wilson intervals, spreads, calibration); NaN becomes null.
std::string to_json(const Summary& summary);

}  // namespace mstsl
