#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "paper_setting.hpp"

namespace mstsl {

/// What one start gave.
struct PaperStart {
  std::vector<ProtocolRun> runs;  ///< by model
  std::optional<RunTrace> trace;  ///< where it was asked for
};

/// One start: the robot aligns itself, drives, and every model's localizer hears the same events. Errors: a
/// waypoint without a way of this length.
Result<PaperStart> run_start(const PaperSetting& setting, const PaperProtocolOptions& options,
                             const TwoStepOptions& two_step, std::size_t number, Traced traced);

}  // namespace mstsl
