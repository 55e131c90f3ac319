#pragma once

#include <cstdint>
#include <functional>

#include "mstsl/core/crew.hpp"
#include "mstsl/core/parallel.hpp"
#include "mstsl/core/result.hpp"

namespace CLI {
class App;
}

namespace mstsl::app {

/// The exit statuses that others script against.
enum class Exit : int { kDone = 0, kFailed = 1, kWrongUsage = 2, kNoFix = 3 };

/// What every subcommand shares: the common options, and the work that the chosen one wants done.
struct Session {
  Threads threads;
  Crew crew;  ///< those who share the work, where a command can share it
  std::uint64_t seed = 1;
  bool quiet = false;
  bool json = false;
  std::function<Result<Exit>()> work;
};

/// Adds --threads, --seed, --quiet and --json to a subcommand.
void add_common_options(CLI::App& command, Session& session);

// One file a subcommand, no algorithm in it: each adds itself to the command line and sets session.work when
// chosen.
void add_bench(CLI::App& app, Session& session);
void add_calibrate(CLI::App& app, Session& session);
void add_convert(CLI::App& app, Session& session);
void add_demo(CLI::App& app, Session& session);
void add_evaluate(CLI::App& app, Session& session);
void add_info(CLI::App& app, Session& session);
void add_localize(CLI::App& app, Session& session);
void add_map(CLI::App& app, Session& session);
void add_simulate(CLI::App& app, Session& session);

}  // namespace mstsl::app
