#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "mstsl/core/result.hpp"

namespace mstsl::io {

/// The whole content of a file. Errors: a file that is absent, a folder, unreadable, or larger than
/// `limit_bytes`.
Result<std::string> read_file(const std::filesystem::path& file, std::size_t limit_bytes);

}  // namespace mstsl::io
