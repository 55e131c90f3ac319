#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/parallel.hpp"
#include "mstsl/magnetic/cross_validation.hpp"
#include "mstsl/magnetic/fingerprint.hpp"

#include "field_area.hpp"
#include "point_bins.hpp"

/// A map is made tile by tile, each from the fingerprints in and around it, whatever regression does it.
namespace mstsl {

/// A fingerprint near a tile.
struct NearFingerprint {
  std::size_t index = 0;
  double weight = 1.0;                                   ///< divides the variance of its noise
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< from the tile's lower left corner
};

/// Mean and variance of the field in a tile, (column, row); empty for components that the engine does not do.
struct TileField {
  std::array<Eigen::MatrixXd, 3> mean_uT, variance_uT2;
  Eigen::MatrixX3d mean_at_fingerprints_uT;  ///< one row each of those given; meaningful within the tile
};

/// Regression of one tile; several threads may call it at once.
class TileEngine {
 public:
  virtual ~TileEngine() = default;
  virtual const std::vector<int>& components() const = 0;
  virtual int cells() const = 0;      ///< side of a tile
  virtual double halo_m() const = 0;  ///< how far around a tile fingerprints matter
  virtual double near_m() const = 0;  ///< cells further from every fingerprint keep the prior
  virtual TileField solve(std::span<const NearFingerprint> around) const = 0;
  /// Standard deviation of a fingerprint's noise, per component, for one that may lie 2 cm off (what tracking
  /// a survey by lidar leaves): where the noise was learned to be less, that is no reason to distrust it.
  virtual Eigen::Array3d noise_sd_uT() const = 0;
};

/// Positions in the frame of the grid, in m from its lower left corner.
std::vector<Eigen::Vector2d> in_grid_frame(std::span<const Fingerprint> fingerprints,
                                           const GridGeometry& geometry);

/// Fingerprints per square metre where they are dense: the 95th percentile over squares of that side. (A
/// square must hold lanes and what lies between them: the constants of the regressions were fitted to the
/// mean over both.)
double dense_samples_per_m2(std::span<const Eigen::Vector2d> positions_m, double side_m);

struct TilingOptions {
  bool heavy_tails = true;  ///< whether fingerprints far from the field are trusted less, see noise_weight()
  Threads threads;
  /// Called now and then with the share done, from one thread at a time.
  std::function<void(double)> progress;
};

/// Fills the engine's components of all wanted cells; `put` writes one of them: cell, component, mean and
/// variance.
using PutCell = std::function<void(std::size_t cell, int component, double mean_uT, double variance_uT2)>;
/// With heavy tails tiles are solved again, with the weights that follow, until those stand (EM).
/// Weights of the fingerprints in the end.
std::vector<double> fill_by_tiles(const TileEngine& engine, std::span<const Fingerprint> fingerprints,
                                  std::span<const Eigen::Vector2d> positions_m, const FieldArea& area,
                                  const TilingOptions& options, const PutCell& put);

}  // namespace mstsl
