#pragma once

#include <filesystem>
#include <memory>

#include "mstsl/core/result.hpp"
#include "mstsl/io/recording.hpp"

#include "io/log/event_source.hpp"

namespace mstsl::io {

/// Opens a recording of any kind that is known, by its content.
Result<std::unique_ptr<EventSource>> open_source(const std::filesystem::path& path,
                                                 const PlayOptions& options, PlayReport& report);

}  // namespace mstsl::io
