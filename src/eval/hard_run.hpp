#pragma once

#include <vector>

#include "mstsl/eval/hard_protocol.hpp"
#include "mstsl/eval/run_trace.hpp"

#include "hard_building.hpp"
#include "hard_listener.hpp"

namespace mstsl {

/// What one run gave: a record for each method, and everything there was to see, if that was asked for.
struct HardDrive {
  std::vector<HardRecord> records;  ///< their keys are the caller's
  RunTrace trace;                   ///< without names and place
};

/// Drives one run through a building and lets every method hear it. Errors: a building without a way of this
/// length.
Result<HardDrive> drive_hard_run(const HardBuilding& building, const std::vector<LocalizerFactory>& methods,
                                 const Disturbance& disturbance, const HardProtocolOptions& options,
                                 const Random& random, Traced traced = Traced::kNo);

}  // namespace mstsl
