#include "tile_fineness.hpp"

#include <algorithm>
#include <cmath>

namespace mstsl {
namespace {

/// Side of a tile, in length scales: a larger one has a larger rank, a smaller one more halo for its area.
constexpr double kTileSide = 6.0;

/// More information than this in a square of a length scale cannot be told from less in double precision.
constexpr double kMostInformation = 5e8;

/// Samples in a square of a length scale, for the needs of the basis: where they are fewer it is their place,
/// not their number, that asks for modes.
constexpr double kFewestSamples = 3.0;

}  // namespace

// The constants were fitted against the exact solution, over lanes 0.3 to 4 length scales apart, noise ratios
// 0.005 to 1 and 1 to 1000 passes of each lane (the tests hold them there). The error of spreading a sample
// to nodes grows with a power of their spacing and must stay below one over the information.
TileFineness::TileFineness(const TileOptions& o) {
  const bool exact = o.quality == RegressionQuality::kExact;
  const double samples = std::max(kFewestSamples, o.samples_per_m2 * o.length_scale_m * o.length_scale_m);
  noise_ratio = std::max(o.noise_ratio, std::sqrt(samples / kMostInformation));
  const double information = std::max(1.0, samples / (noise_ratio * noise_ratio));
  tolerance = std::clamp((exact ? 8e-5 : 7e-4) / information, 1e-12, 1e-5);
  fading = (exact ? 0.7 : 0.9) * std::pow(information / 2000.0, -0.075);
  halo = std::pow(13.0 / fading, 2.0 / 3.0);
  spacing = std::min(0.2, (exact ? 0.16 : 0.2) * std::pow(information / 1400.0, -0.125));
}

int tile_cells(const TileOptions& o) {
  return o.cells > 0 ? o.cells
                     : std::max(4, static_cast<int>(std::lround(kTileSide * o.length_scale_m / o.cell_m)));
}

}  // namespace mstsl
