#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "mstsl/core/result.hpp"

#include "session.hpp"

/// The parts of `mstsl info`: each kind of file is described as one JSON object, which is printed as it is or
/// as text.
namespace mstsl::app {

using Description = nlohmann::ordered_json;

Result<Description> describe_map(const std::filesystem::path& file);
Result<Description> describe_field(const std::filesystem::path& file);
Result<Description> describe_estimates(const std::filesystem::path& file);
Result<Description> describe_truth(const std::filesystem::path& file);
/// Plays the whole log, to count what is wrong with it.
Result<Description> describe_log(const std::filesystem::path& file, const Session& session);

/// The description in lines for people: "name: value", lists of objects as tables, units after the values.
std::string to_text(const Description& description);

}  // namespace mstsl::app
