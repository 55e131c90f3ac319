#pragma once

#include <memory>

#include "mstsl/core/result.hpp"

#include "io/input_file.hpp"
#include "io/log/message_log.hpp"

namespace mstsl::io {

/// Whether the file begins as MCAP files do.
bool is_mcap(const InputFile& file);

/// Errors: not an MCAP file of version 0. One that is damaged or ends in the middle is opened.
Result<std::unique_ptr<MessageLog>> open_mcap(InputFile file);

}  // namespace mstsl::io
