#pragma once

#include <filesystem>
#include <memory>

#include "mstsl/core/result.hpp"
#include "mstsl/io/recording.hpp"

#include "io/log/event_source.hpp"
#include "io/log/message_log.hpp"

namespace mstsl::io {

enum class LogFormat { kMcap, kRosbag2Folder, kBag, kCarmen };

/// What kind of log a file or folder is, by its content. Errors: none that is known, or not readable.
Result<LogFormat> find_format(const std::filesystem::path& path);

/// Opens a log of messages: any format but CARMEN's.
Result<std::unique_ptr<MessageLog>> open_messages(const std::filesystem::path& path, LogFormat format);

/// Opens a recording of any format.
Result<std::unique_ptr<EventSource>> open_source(const std::filesystem::path& path,
                                                 const PlayOptions& options, PlayReport& report);

}  // namespace mstsl::io
