#pragma once

#include <filesystem>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"

namespace mstsl::io {

/// Writes true poses of base_link in the map as CSV with the header `t,x,y,yaw` (s, m, m, rad), atomically.
Result<void> write_truth(const std::vector<PoseReading>& poses, const std::filesystem::path& file);

/// Reads such a table. Errors: another header, a line that has not four finite numbers, stamps that go back
/// (each with the line's number), a table without rows.
Result<std::vector<PoseReading>> read_truth(const std::filesystem::path& file);

}  // namespace mstsl::io
