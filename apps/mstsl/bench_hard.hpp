#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "session.hpp"

namespace CLI {
class App;
}

namespace mstsl::app {

/// What a user may ask of `bench --protocol hard`.
struct HardWish {
  std::vector<std::string> methods{"two-step", "joint"};
  std::vector<std::string> worlds, cases{"none", "all"};
  std::string set = "fix";
  int buildings = 1, beams = 541;
  double length_m = 14.0, scan_rate_hz = 10.0;
  std::size_t replays = 12;
};

void add_hard_options(CLI::App& command, HardWish& wish);

/// Runs it and writes report, table, results and cost into `folder`.
Result<Exit> bench_hard(const Session& session, const HardWish& wish, int runs,
                        const std::filesystem::path& folder);

}  // namespace mstsl::app
