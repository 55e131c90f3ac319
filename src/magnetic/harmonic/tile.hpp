#pragma once

#include <array>
#include <memory>
#include <span>

#include <Eigen/Core>

#include "mstsl/magnetic/harmonic_covariance.hpp"
#include "mstsl/magnetic/tile_regression.hpp"

/// Regression of one square tile of cells with the harmonic covariance. Its waves on a periodic box around
/// the tile are independent a priori, and the sums over samples that their normal matrix needs depend only on
/// differences and sums of two waves' numbers: they are one table, whatever the number of samples.
namespace mstsl {

struct HarmonicTileOptions {
  HarmonicHyperparameters field;
  double cell_m = 0.05;
  int cells = 0;                ///< side of the tile in cells; 0 chooses the cheapest
  double samples_per_m2 = 100;  ///< where they are densest: more data need more waves
  RegressionQuality quality = RegressionQuality::kFast;
};

/// What decides cost and accuracy, lengths in depths.
struct HarmonicFineness {
  double side, halo, margin;
  double tolerance;  ///< waves whose information against the prior is less are left out
};
HarmonicFineness harmonic_fineness(RegressionQuality quality);

class HarmonicTile {
 public:
  explicit HarmonicTile(const HarmonicTileOptions& options)
      : HarmonicTile(options, harmonic_fineness(options.quality)) {}
  HarmonicTile(const HarmonicTileOptions& options, const HarmonicFineness& fineness);
  HarmonicTile(HarmonicTile&&) noexcept;
  ~HarmonicTile();

  int cells() const;
  /// Samples further than this outside the tile do not matter to it.
  double halo_m() const;
  /// Unknowns of the largest system solved.
  int rank() const;

  /// (column, row) is the cell; in units of signal_sd_uT.
  struct Posterior {
    std::array<Eigen::MatrixXd, 3> mean, variance;
    Eigen::MatrixX3d mean_at_samples;  ///< one row a sample; 0 for those outside tile and halo
  };

  /// Memory for one solution after another; one thread at a time may use it.
  class Workspace {
   public:
    Workspace();
    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;
    ~Workspace();

   private:
    friend class HarmonicTile;
    struct State;
    std::unique_ptr<State> state_;
  };
  /// Values of samples are deviations from the mean in units of signal_sd_uT.
  Posterior solve(std::span<const TileSample> samples, Workspace& workspace) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace mstsl
