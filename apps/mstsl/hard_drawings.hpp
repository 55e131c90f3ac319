#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/eval/hard_record.hpp"

namespace mstsl::app {

/// The figures of `bench --protocol hard`, hard_SET_NAME.svg in `folder`: success by world and by
/// disturbance, the distance to a right pose, the error afterwards, reliability, and where robots were
/// carried how soon that was noticed and mended. Errors: a folder that cannot be written.
Result<void> draw_hard_figures(const std::vector<HardRecord>& records, const std::string& set,
                               const std::filesystem::path& folder);

}  // namespace mstsl::app
