#pragma once

#include <vector>

#include "mstsl/eval/hard_protocol.hpp"

#include "hard_building.hpp"

namespace mstsl {

/// Drives one run through a building and lets every method hear it. The records' keys are the caller's.
/// Errors: a building without a way of this length.
Result<std::vector<HardRecord>> drive_hard_run(const HardBuilding& building,
                                               const std::vector<LocalizerFactory>& methods,
                                               const Disturbance& disturbance,
                                               const HardProtocolOptions& options, const Random& random);

}  // namespace mstsl
