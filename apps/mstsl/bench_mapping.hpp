#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/eval/mapping_protocol.hpp"

#include "session.hpp"

namespace CLI {
class App;
}

namespace mstsl::app {

/// What a user may ask of `bench --protocol mapping`.
struct MappingWish {
  std::vector<std::string> robots = mapping_robot_names();
  double length_m = MappingProtocolOptions{}.length_m;
};

void add_mapping_options(CLI::App& command, MappingWish& wish);

/// Runs the mapping protocol in the given worlds (none: its own choice) and writes mapping.txt and
/// mapping.json.
Result<Exit> bench_mapping(const Session& session, const MappingWish& wish,
                           const std::vector<std::string>& worlds, int runs,
                           const std::filesystem::path& folder);

}  // namespace mstsl::app
