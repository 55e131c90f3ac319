#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/magnetic/field_map.hpp"

#include "find_start.hpp"
#include "session.hpp"
#include "survey_reader.hpp"

namespace mstsl::app {

/// Drives through a mapped building: what they measured where, and how they were found.
struct LocatedDrives {
  SurveyLogs survey;
  std::vector<FoundStart> found;  ///< of each log found; none where the user or the logs said where they were
};

/// Finds each log on the maps by the joint method, then tracks it from there to its end; what it measured
/// before it was found is left out, and so is, with a warning, a log that is not found. Errors: logs of which
/// none is found, one that cannot be read or tracked; an interrupt.
Result<LocatedDrives> locate_drives(const Session& session, const std::vector<std::filesystem::path>& logs,
                                    const io::PlayOptions& play, const OccupancyGrid& occupancy,
                                    const FieldMap& field);

}  // namespace mstsl::app
