#pragma once

#include <string>

#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/viz/canvas.hpp"

namespace mstsl::viz {

/// A field map on one sheet: its components, its strength and its standard deviation in colours, and what the
/// survey covered (cells that a fingerprint supports, those that none does, and the lines driven), each over
/// the walls.
Canvas draw_field(const OccupancyGrid& map, const FieldMap& field, const std::string& title,
                  double width_px = 2000.0);

}  // namespace mstsl::viz
