#pragma once

#include <string>
#include <vector>

#include "mstsl/eval/hard_protocol.hpp"
#include "mstsl/eval/run_trace.hpp"

namespace mstsl {

/// A run of the protocol, whatever the methods.
struct HardStart {
  std::string world, disturbance;
  int run = 0;
  friend bool operator==(const HardStart&, const HardStart&) = default;
};

/// Runs worth looking at: of each world the first under the last disturbance, and those that went wrong (a
/// wrong or late first pose, none, a wrong claim, a right pose withdrawn) for the methods in the order of
/// `methods`, up to `most` in all.
std::vector<HardStart> worth_looking_at(const std::vector<HardRecord>& records,
                                        const std::vector<std::string>& methods, std::size_t most);

/// Drives these runs again, the very same events, and keeps all there is to see. Errors: as
/// run_hard_protocol().
Result<std::vector<RunTrace>> trace_hard_runs(const HardProtocolOptions& options,
                                              const std::vector<HardStart>& starts);

}  // namespace mstsl
