#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mstsl/core/crew.hpp"
#include "mstsl/core/parallel.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/eval/hard_record.hpp"
#include "mstsl/localize/methods.hpp"

namespace mstsl {

/// What happens in a run.
enum class CaseSet {
  kFix,     ///< switched on somewhere, driven 14 m
  kKidnap,  ///< the same, then carried 5-50 m in the dark and driven on
  kLong,    ///< driven for a long time
};
/// "fix", "kidnap", "long".
std::string_view to_string(CaseSet set);

/// What can be switched on, by name: "none", one disturbance each, "all" (every one but "turn" and those that
/// leave a sensor out), "no-magnetometer".
std::vector<std::string> disturbance_names();
/// The worlds that the protocol is made for; any of sim::world_names() may be asked for.
std::vector<std::string> hard_world_names();

/// Worlds x disturbances x runs, each method on the same events.
struct HardProtocolOptions {
  std::vector<std::string> methods{"two-step"};
  MethodOptions method_options;
  std::vector<std::string> worlds = hard_world_names();
  std::vector<std::string> disturbances{"none", "all"};
  CaseSet set = CaseSet::kFix;
  int runs = 10;           ///< of each world and disturbance
  int buildings = 1;       ///< of each world, with other steel; the runs take turns in them
  double length_m = 14.0;  ///< driven per run; in the set kidnap before and after the carrying each
  double scan_rate_hz = 10.0;
  int beams = 541;
  std::uint64_t seed = 1;
  Threads threads;
  Crew crew;  ///< the processes that share the runs; a folder in common or one for each will do
  /// Field maps and finished runs are kept here, so that a run that was interrupted goes on.
  std::filesystem::path folder;
  std::string build;  ///< of the program; runs kept from another build are made anew
  /// Called now and then, by one thread at a time; false ends the protocol. What is finished is kept.
  std::function<bool(const char* what, double share)> progress;
};

/// Makes the runs that `folder` does not have yet. The records of all runs asked for, in the order world,
/// disturbance, run, method, the same at any number of threads and processes but for the cost. Errors: names
/// that are not there, a building or map that cannot be made, a folder that cannot be written, an end asked
/// for; of any process for all of them.
Result<std::vector<HardRecord>> run_hard_protocol(const HardProtocolOptions& options);

}  // namespace mstsl
