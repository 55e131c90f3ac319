#pragma once

#include <filesystem>
#include <memory>

#include "mstsl/core/result.hpp"
#include "mstsl/io/recording.hpp"

#include "io/log/event_source.hpp"

namespace mstsl::io {

/// Whether the file, packed by gzip or not, begins like a CARMEN log.
bool is_carmen(const std::filesystem::path& path);

/// Scans and odometry of a CARMEN log and, where a pose topic is wanted, its corrected poses. Such a log has
/// no magnetometer, which a warning says. Errors: it holds no scan.
Result<std::unique_ptr<EventSource>> open_carmen_source(const std::filesystem::path& path,
                                                        const PlayOptions& options, PlayReport& report);

}  // namespace mstsl::io
