#pragma once

#include <vector>

#include "mstsl/core/parallel.hpp"
#include "mstsl/magnetic/tile_regression.hpp"

#include "harmonic/tile.hpp"
#include "tiling.hpp"

namespace mstsl {

/// Components that share one squared exponential covariance.
class IndependentEngine final : public TileEngine {
 public:
  /// Keeps a reference to the fingerprints.
  IndependentEngine(std::span<const Fingerprint> fingerprints, const FieldHyperparameters& h,
                    std::vector<int> components, double cell_m, double samples_per_m2,
                    RegressionQuality quality);

  const std::vector<int>& components() const override { return components_; }
  int cells() const override { return tile_.cells(); }
  double halo_m() const override { return tile_.halo_m(); }
  double near_m() const override;
  TileField solve(std::span<const NearFingerprint> around) const override;
  Eigen::Array3d noise_sd_uT() const override;

 private:
  std::span<const Fingerprint> fingerprints_;
  FieldHyperparameters h_;
  std::vector<int> components_;
  TileRegression tile_;
  mutable Spares<TileRegression::Workspace> workspaces_;
};

/// All three components, tied by the potential that they are the gradient of.
class HarmonicEngine final : public TileEngine {
 public:
  /// Keeps a reference to the fingerprints.
  HarmonicEngine(std::span<const Fingerprint> fingerprints, const HarmonicHyperparameters& h, double cell_m,
                 double samples_per_m2, RegressionQuality quality);

  const std::vector<int>& components() const override { return components_; }
  int cells() const override { return tile_.cells(); }
  double halo_m() const override { return tile_.halo_m(); }
  double near_m() const override;
  TileField solve(std::span<const NearFingerprint> around) const override;
  Eigen::Array3d noise_sd_uT() const override;

 private:
  std::span<const Fingerprint> fingerprints_;
  HarmonicHyperparameters h_;
  std::vector<int> components_ = {0, 1, 2};
  HarmonicTile tile_;
  mutable Spares<HarmonicTile::Workspace> workspaces_;
};

}  // namespace mstsl
