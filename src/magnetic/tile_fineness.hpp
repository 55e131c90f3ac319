#pragma once

#include "mstsl/magnetic/tile_regression.hpp"

namespace mstsl {

/// How finely a tile is worked on.
struct TileFineness {
  explicit TileFineness(const TileOptions& options);

  double noise_ratio;    ///< the option's, or more where so many samples lie that their sum is past double
                         ///< precision
  double tolerance;      ///< modes with less importance are left out
  double fading;         ///< of the attention to nodes outside the tile
  double halo, spacing;  ///< in length scales
};

/// Side of a tile in cells.
int tile_cells(const TileOptions& options);

}  // namespace mstsl
