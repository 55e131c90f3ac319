#pragma once

#include <filesystem>
#include <string>

#include "mstsl/core/result.hpp"
#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/viz/canvas.hpp"

#include "drive_mapping.hpp"

namespace mstsl::app {

/// What was mapped, how the loops were closed and what is to be trusted, for people and for programs.
std::string drive_report_text(const MappedDrives& mapped);
std::string drive_report_json(const MappedDrives& mapped);

/// The map with the ways driven on it, and the field under them if there is one.
viz::Canvas draw_ways(const MappedDrives& mapped, const FieldMap* field, const std::string& title);

/// Where the robot was, in TUM format: of several drives one file each, NAME_0.tum, NAME_1.tum ...
Result<void> write_ways(const MappedDrives& mapped, const std::filesystem::path& file);

}  // namespace mstsl::app
