#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"

#include "session.hpp"

namespace mstsl::app {

/// Runs the mapping protocol in the given worlds (none: its own choice) and writes mapping.txt and
/// mapping.json.
Result<Exit> bench_mapping(const Session& session, const std::vector<std::string>& worlds, int runs,
                           const std::filesystem::path& folder);

}  // namespace mstsl::app
