#include "tile_engines.hpp"

#include <algorithm>
#include <utility>

#include "field_models.hpp"

namespace mstsl {
namespace {

using Eigen::Array3d;

TileOptions tile_options(const FieldHyperparameters& h, int component, double cell_m, double samples_per_m2,
                         RegressionQuality quality) {
  TileOptions tile;
  tile.length_scale_m = h.length_scale_m(component);
  tile.noise_ratio =
      std::max(h.noise_sd_uT(component) / h.signal_sd_uT(component), TileRegression::kMinNoiseRatio);
  tile.cell_m = cell_m;
  tile.samples_per_m2 = samples_per_m2;
  tile.quality = quality;
  return tile;
}

std::vector<TileSample> samples_of(std::span<const NearFingerprint> around,
                                   std::span<const Fingerprint> fingerprints, const Array3d& mean_uT,
                                   const Array3d& unit_uT) {
  std::vector<TileSample> samples;
  for (const NearFingerprint& near : around)
    samples.push_back(
        {near.position_m, (fingerprints[near.index].field_uT.array() - mean_uT) / unit_uT, near.weight});
  return samples;
}

Eigen::MatrixX3d in_uT(const Eigen::MatrixX3d& deviations, const Array3d& mean_uT, const Array3d& unit_uT) {
  return (deviations.array().rowwise() * unit_uT.transpose()).rowwise() + mean_uT.transpose();
}

/// A field's slope has the standard deviation of the signal over its length.
Array3d noise_with_position(const FieldHyperparameters& h) {
  constexpr double kPositionSd_m = 0.02;
  return (h.noise_sd_uT.square() + (kPositionSd_m * h.signal_sd_uT / h.length_scale_m).square()).sqrt();
}

}  // namespace

IndependentEngine::IndependentEngine(std::span<const Fingerprint> fingerprints, const FieldHyperparameters& h,
                                     std::vector<int> components, double cell_m, double samples_per_m2,
                                     RegressionQuality quality)
    : fingerprints_(fingerprints),
      h_(h),
      components_(std::move(components)),
      tile_(tile_options(h, components_.front(), cell_m, samples_per_m2, quality)) {}

double IndependentEngine::near_m() const { return kPriorBeyond * h_.length_scale_m(components_.front()); }

Array3d IndependentEngine::noise_sd_uT() const { return noise_with_position(h_); }

TileField IndependentEngine::solve(std::span<const NearFingerprint> around) const {
  auto workspace = workspaces_.take();
  const auto posterior =
      tile_.solve(samples_of(around, fingerprints_, h_.mean_uT, h_.signal_sd_uT), workspace);
  workspaces_.give(std::move(workspace));
  TileField field;
  for (const int c : components_) {
    const auto k = static_cast<std::size_t>(c);
    const double sd_uT = h_.signal_sd_uT(c);
    field.mean_uT[k] = h_.mean_uT(c) + sd_uT * posterior.mean[k].array();
    field.variance_uT2[k] = sd_uT * sd_uT * posterior.variance.array().min(1.0);
  }
  field.mean_at_fingerprints_uT = in_uT(posterior.mean_at_samples, h_.mean_uT, h_.signal_sd_uT);
  return field;
}

HarmonicEngine::HarmonicEngine(std::span<const Fingerprint> fingerprints, const HarmonicHyperparameters& h,
                               double cell_m, double samples_per_m2, RegressionQuality quality)
    : fingerprints_(fingerprints), h_(h), tile_({h, cell_m, 0, samples_per_m2, quality}) {}

double HarmonicEngine::near_m() const { return kPriorBeyond * as_independent(h_).length_scale_m(0); }

Array3d HarmonicEngine::noise_sd_uT() const { return noise_with_position(as_independent(h_)); }

TileField HarmonicEngine::solve(std::span<const NearFingerprint> around) const {
  auto workspace = workspaces_.take();
  const double sd_uT = h_.signal_sd_uT;
  const auto posterior =
      tile_.solve(samples_of(around, fingerprints_, h_.mean_uT, Array3d::Constant(sd_uT)), workspace);
  workspaces_.give(std::move(workspace));
  TileField field;
  const Array3d prior_uT2 = h_.component_sd_uT().square();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto c = static_cast<int>(k);
    field.mean_uT[k] = h_.mean_uT(c) + sd_uT * posterior.mean[k].array();
    field.variance_uT2[k] = (sd_uT * sd_uT * posterior.variance[k].array()).min(prior_uT2(c));
  }
  field.mean_at_fingerprints_uT = in_uT(posterior.mean_at_samples, h_.mean_uT, Array3d::Constant(sd_uT));
  return field;
}

}  // namespace mstsl
