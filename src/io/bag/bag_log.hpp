#pragma once

#include <memory>

#include "mstsl/core/result.hpp"

#include "io/input_file.hpp"
#include "io/log/message_log.hpp"

namespace mstsl::io {

/// Whether the file begins as ROS 1 bags of any version do.
bool is_bag(const InputFile& file);

/// Errors: a bag of another version than 2.0, or an encrypted one. One that was never closed, is damaged or
/// ends in the middle is opened.
Result<std::unique_ptr<MessageLog>> open_bag(InputFile file);

}  // namespace mstsl::io
