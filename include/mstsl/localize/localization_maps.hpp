#pragma once

#include <memory>

#include "mstsl/core/lazy.hpp"
#include "mstsl/core/parallel.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/magnetic/field_sampler.hpp"
#include "mstsl/magnetic/matcher.hpp"
#include "mstsl/scan/match_submap.hpp"

namespace mstsl {

/// The paper's M = [m^B, m^L], made ready for use. Made once, then only read, by as many runs and threads as
/// like.
struct LocalizationMaps {
  OccupancyGrid occupancy;
  FieldSampler field_cells;
  double building_axis_rad;    ///< x axis of the map's body frame
  double field_on_free_share;  ///< of the field's supported places: those that the walls' map calls free
  Lazy<MatchMap> walls;        ///< for matching scans by a pyramid, as the paper and Cartographer do
  Lazy<FieldMatcher> field;    ///< for finding single readings, as the paper does
};

struct LocalizationMapsOptions {
  /// Least share of the field map's supported places that must be free in the occupancy map. A survey reaches
  /// a little into walls at its edges; a field map of another place covers free cells by chance only.
  double min_field_on_free_share = 0.6;
  Threads threads;
};

/// Puts an occupancy map and a field map together; the field is used on free cells only. Errors: a map
/// without a free cell or without a wall, a field map without values, maps that are not of one place.
Result<std::shared_ptr<const LocalizationMaps>> make_localization_maps(
    OccupancyGrid occupancy, FieldMap field, const LocalizationMapsOptions& options = {});

}  // namespace mstsl
