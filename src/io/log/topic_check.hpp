#pragma once

#include "mstsl/core/result.hpp"
#include "mstsl/io/recording.hpp"

#include "io/log/message_log.hpp"

namespace mstsl::io {

/// Whether the log has what was asked for. Errors: a topic is not there, holds no message, or carries another
/// type or encoding; the sentence lists what is there. Static transforms and inertial data may be missing.
Result<void> check_topics(const std::string& log_name, const std::vector<Channel>& channels,
                          const Topics& topics);

}  // namespace mstsl::io
