#pragma once

#include <string>

#include "map_occupancy.hpp"

namespace mstsl::app {

/// What was mapped, how the loops were closed and what is to be trusted, for people and for programs.
std::string drive_report_text(const MappedDrive& drive);
std::string drive_report_json(const MappedDrive& drive);

}  // namespace mstsl::app
