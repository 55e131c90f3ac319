#pragma once

#include <functional>

#include "mstsl/viz/canvas.hpp"
#include "mstsl/viz/picture.hpp"

namespace mstsl::viz {

/// A range of values that colours are spread over.
struct ValueRange {
  double low = 0.0;
  double high = 1.0;
  double share(double value) const { return (value - low) / (high - low); }
};

/// The value that a cell of a field map shows; NaN where there is none.
double field_value(const FieldMap& field, std::size_t cell, FieldQuantity quantity);

/// The 1st to 99th percentile of what is shown over free cells: a single magnet does not bleach all else.
ValueRange shown_range(const FieldMap& field, const OccupancyGrid& map, FieldQuantity quantity);

/// The floor: one pixel a cell where the map is free.
Raster floor_raster(const OccupancyGrid& map);

/// The walls alone, one pixel for each square of `cells` cells: opaque if any of them is occupied, so that
/// walls stay visible on a map much larger than the sheet.
Raster wall_raster(const OccupancyGrid& map, int cells);

/// The field, one pixel a cell where the map is free.
Raster field_raster(const FieldMap& field, const OccupancyGrid& map, FieldQuantity quantity,
                    const ValueRange& range);

}  // namespace mstsl::viz
