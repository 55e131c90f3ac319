#pragma once

#include <filesystem>
#include <memory>

#include "mstsl/core/result.hpp"

#include "io/log/message_log.hpp"

namespace mstsl::io {

/// Opens the folder that rosbag2 records into: metadata.yaml and MCAP files, which are one recording. Where
/// the recorder was killed metadata.yaml is absent, and all MCAP files of the folder are taken. Errors:
/// another storage (sqlite3), compression by rosbag2 itself instead of by MCAP, no file.
Result<std::unique_ptr<MessageLog>> open_rosbag2_folder(const std::filesystem::path& folder);

}  // namespace mstsl::io
