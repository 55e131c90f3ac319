#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/magnetic/field_update.hpp"

#include "located_drives.hpp"

namespace mstsl::app {

/// The log of a drive; `first` is the session of the first log.
std::string name_of(const LocatedDrives& drives, const DriveComparison& drive, std::size_t first);

/// What `mstsl map update` tells: for people, and as one JSON object. `made` is the new map, if one was made.
std::string update_report_text(const LocatedDrives& drives, const FieldUpdate& update,
                               const std::optional<FieldMap>& made, std::size_t first);
std::string update_report_json(const LocatedDrives& drives, const FieldUpdate& update,
                               const std::optional<FieldMap>& made, std::size_t first);

}  // namespace mstsl::app
