#pragma once

#include <cstddef>
#include <string>

#include "mstsl/eval/run_trace.hpp"

namespace mstsl::report {

/// A run as replay.js reads it. Times in s since the run's first event, lengths in m, scan points in cm.
std::string run_json(const RunTrace& run, std::size_t place);

/// A place's maps as map.js reads them: the occupancy grid's states in runs (unknown, free, occupied,
/// unknown,
/// ...), cropped to what is known; |B| in bytes (255: nothing), on cells of at least 0.1 m.
std::string place_json(const TracedPlace& place);

}  // namespace mstsl::report
