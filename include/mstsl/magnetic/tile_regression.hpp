#pragma once

#include <array>
#include <memory>
#include <span>

#include <Eigen/Core>

#include "mstsl/core/result.hpp"

/// Gaussian-process regression of one square tile of cells from the samples in and around it, at a cost that
/// does not grow with their number: the squared-exponential covariance is separable, so it is
/// eigen-factorised once per axis on a lattice of nodes, and the data are spread to the nodes with Lagrange
/// weights that keep their moments.
///
/// The factorisation is weighted: exact in the tile, coarser the further a node lies in the halo around it,
/// and what it leaves out there is added to the samples' noise (as FITC does, Snelson & Ghahramani 2006).
/// This halves the rank, and so cuts the cost eightfold, at the same error.
namespace mstsl {

/// How closely a tile follows the exact solution (measured; docs and tests show it).
enum class RegressionQuality {
  kFast,  ///< mean within about 3 % of the noise (rms), variance within 1 %
  kExact  ///< mean within 1 % of the noise, variance within 0.5 %
};

/// Everything in units of the signal's standard deviation.
struct TileSample {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< from the tile's lower left corner
  Eigen::Array3d value = Eigen::Array3d::Zero();  ///< three independent fields that share the covariance
  double weight = 1.0;  ///< divides the noise variance: 0 for a sample to be ignored
};

struct TileOptions {
  double length_scale_m = 1.0;
  double noise_ratio = 0.1;     ///< noise over signal standard deviation; at least kMinNoiseRatio
  double cell_m = 0.05;         ///< side of a cell
  int cells = 0;                ///< side of the tile in cells; 0 chooses the cheapest
  double samples_per_m2 = 100;  ///< where they are densest: more data need a finer factorisation
  RegressionQuality quality = RegressionQuality::kFast;
};

class TileRegression {
 public:
  /// Below this the covariance matrix is numerically singular; position errors of 5 mm cost as much.
  static constexpr double kMinNoiseRatio = 0.005;

  explicit TileRegression(const TileOptions& options);
  TileRegression(TileRegression&&) noexcept;
  ~TileRegression();

  int cells() const;
  /// Samples further than this outside the tile do not matter to it.
  double halo_m() const;
  /// Number of basis functions.
  int rank() const;

  /// Columns along x, rows along y: (column, row) is the cell in TileOptions' units. Variance of the field
  /// itself.
  struct Posterior {
    std::array<Eigen::MatrixXd, 3> mean;
    Eigen::MatrixXd variance;
    Eigen::MatrixX3d mean_at_samples;  ///< one row a sample; 0 for those outside the tile
  };

  /// Memory for one solution after another; one thread at a time may use it.
  class Workspace {
   public:
    Workspace();
    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;
    ~Workspace();

   private:
    friend class TileRegression;
    struct State;
    std::unique_ptr<State> state_;
  };
  Posterior solve(std::span<const TileSample> samples, Workspace& workspace) const;
  Posterior solve(std::span<const TileSample> samples) const {
    Workspace workspace;
    return solve(samples, workspace);
  }

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace mstsl
