#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/magnetic/fingerprint.hpp"

namespace mstsl {

/// The cells of a field map: where they lie, which of them get a value, and how far each is from a
/// fingerprint.
struct FieldArea {
  GridGeometry geometry;
  std::vector<std::uint8_t> wanted;
  std::vector<float> distance_m;  ///< to the nearest fingerprint, to within a cell; at most far_m
  float far_m = 0.0F;
};

/// From each cell to the nearest fingerprint, in m, to within a cell; at most `far_m`.
std::vector<float> distances_to(std::span<const Fingerprint> fingerprints, const GridGeometry& geometry,
                                double far_m);

/// Without an occupancy grid: all cells within `reach_m` of a fingerprint, along the map's axes. With one:
/// along its axes, its free cells, two cells of border around them so that they can be interpolated between,
/// and what was surveyed beyond them. Distances are known up to `far_m`. Errors: a place too large for
/// memory, a resolution that is no such.
Result<FieldArea> make_field_area(std::span<const Fingerprint> fingerprints, const OccupancyGrid* occupancy,
                                  double resolution_m, double reach_m, double far_m);

}  // namespace mstsl
