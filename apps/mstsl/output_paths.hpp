#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "mstsl/core/result.hpp"

namespace mstsl::app {

/// An error where writing an output would destroy an input: a slip in a command line must not cost a
/// recording.
std::optional<Error> overwritten_input(const std::vector<std::filesystem::path>& outputs,
                                       const std::vector<std::filesystem::path>& inputs);

}  // namespace mstsl::app
