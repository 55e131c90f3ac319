#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

#include "harmonic/dense.hpp"
#include "harmonic/tile.hpp"
#include "pole_sheets.hpp"

namespace mstsl {
namespace {

struct Regime {
  const char* name;
  SourceSide side;
  double lane_depths, noise,
      per_depth;  ///< lanes apart in depths; noise in signal SDs; samples along a depth
};
std::ostream& operator<<(std::ostream& out, const Regime& r) { return out << r.name; }

struct Deviations {
  double mean_of_noise;   ///< rms of the mean's error, in noise SDs
  double variance_share;  ///< largest error of the variance, as a share of that of a later reading
};

/// A tile's posterior against that of the dense solution from everything three depths around.
Deviations deviations(const Regime& r, RegressionQuality quality) {
  HarmonicTileOptions options;
  options.field.side = r.side;
  options.field.depth_m = 1.0;
  options.field.signal_sd_uT = 1.0;
  options.field.noise_sd_uT = Eigen::Array3d::Constant(r.noise);
  options.cell_m = 0.2;
  options.samples_per_m2 = r.per_depth / r.lane_depths;
  options.quality = quality;
  const HarmonicTile tile(options);
  const double side_m = tile.cells() * options.cell_m, around_m = 2.0;
  Random random(7);
  const test::PoleSheets sheets(r.side, random);
  std::vector<TileSample> samples;
  std::vector<Fingerprint> fingerprints;
  for (double y = -around_m + 0.3; y < side_m + around_m; y += r.lane_depths)
    for (double x = -around_m; x < side_m + around_m; x += 1.0 / r.per_depth) {
      Eigen::Array3d value = sheets.at({x, y});
      for (int c = 0; c < 3; ++c) value(c) += random.normal(0, r.noise);
      samples.push_back({{x, y}, value, 1.0});
      fingerprints.push_back({{x, y}, value.matrix(), 0.0, 0});
    }
  std::vector<Eigen::Vector2d> cells;
  for (int row = 0; row < tile.cells(); ++row)
    for (int column = 0; column < tile.cells(); ++column)
      cells.emplace_back((column + 0.5) * options.cell_m, (row + 0.5) * options.cell_m);
  const auto exact = harmonic_predictor(options.field)(fingerprints, cells);
  HarmonicTile::Workspace workspace;
  const auto fast = tile.solve(samples, workspace);
  Deviations worst{0, 0};
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto column = static_cast<int>(i) % tile.cells(), row = static_cast<int>(i) / tile.cells();
      const double error = fast.mean[c](column, row) - exact[i]->mean_uT(c);
      worst.mean_of_noise += error * error;
      const double reading = exact[i]->variance_uT2(c) + r.noise * r.noise;
      worst.variance_share =
          std::max(worst.variance_share,
                   std::abs(fast.variance[c](column, row) - exact[i]->variance_uT2(c)) / reading);
    }
  worst.mean_of_noise = std::sqrt(worst.mean_of_noise / static_cast<double>(3 * cells.size())) / r.noise;
  return worst;
}

class HarmonicTileRegimes : public testing::TestWithParam<Regime> {};

// Measured: fast 0.03-0.09 of the noise and 1 % on lanes up to 0.4 depths apart; a third of the noise, and
// variances up to a third too large, where lanes lie a depth apart, since what lies beyond the halo matters
// more there.
TEST_P(HarmonicTileRegimes, FollowTheDenseSolution) {
  const Deviations fast = deviations(GetParam(), RegressionQuality::kFast),
                   exact = deviations(GetParam(), RegressionQuality::kExact);
  const bool dense = GetParam().lane_depths < 0.5;
  EXPECT_LT(fast.mean_of_noise, dense ? 0.12 : 0.5);
  EXPECT_LT(fast.variance_share, dense ? 0.02 : 0.4);
  EXPECT_LT(exact.mean_of_noise, dense ? 0.05 : 0.1);
  EXPECT_LT(exact.variance_share, dense ? 0.01 : 0.02);
}

INSTANTIATE_TEST_SUITE_P(All, HarmonicTileRegimes,
                         testing::Values(Regime{"below", SourceSide::kBelow, 0.4, 0.1, 6},
                                         Regime{"above", SourceSide::kAbove, 0.4, 0.1, 6},
                                         Regime{"both", SourceSide::kBoth, 0.4, 0.1, 6},
                                         Regime{"much_noise", SourceSide::kBelow, 0.4, 0.5, 6},
                                         Regime{"little_noise", SourceSide::kBoth, 0.25, 0.03, 8},
                                         Regime{"lanes_far_apart", SourceSide::kBoth, 1.0, 0.1, 10}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(HarmonicTile, WithoutSamplesIsThePrior) {
  HarmonicTileOptions options;
  options.cell_m = 0.5;
  const HarmonicTile tile(options);
  HarmonicTile::Workspace workspace;
  const auto posterior = tile.solve({}, workspace);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(posterior.mean[c].cwiseAbs().maxCoeff(), 0.0);
    EXPECT_NEAR(posterior.variance[c].minCoeff(), c == 2 ? 1.0 : 0.5, 0.02);
    EXPECT_NEAR(posterior.variance[c].maxCoeff(), c == 2 ? 1.0 : 0.5, 0.02);
  }
}

TEST(HarmonicTile, MeanAtSamplesIsThatOfTheCellsTheyLieIn) {
  for (const SourceSide side : {SourceSide::kBelow, SourceSide::kBoth}) {
    HarmonicTileOptions options;
    options.field.side = side;
    options.cell_m = 0.5;
    const HarmonicTile tile(options);
    Random random(4);
    std::vector<TileSample> samples;
    for (int column = 0; column < tile.cells(); ++column)
      samples.push_back(
          {{(column + 0.5) * options.cell_m, 2.25}, {random.normal(), random.normal(), 1.0}, 1.0});
    HarmonicTile::Workspace workspace;
    const auto posterior = tile.solve(samples, workspace);
    for (int column = 0; column < tile.cells(); ++column)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(posterior.mean_at_samples(column, c),
                    posterior.mean[static_cast<std::size_t>(c)](column, 4), 1e-9);
  }
}

/// A sample of weight 0 is none, and one of weight 2 two of them.
TEST(HarmonicTile, WeightsCountSamples) {
  HarmonicTileOptions options;
  options.cell_m = 0.5;
  const HarmonicTile tile(options);
  Random random(3);
  std::vector<TileSample> weighted, repeated;
  for (int i = 0; i < 60; ++i) {
    TileSample sample{{random.uniform(-1, 5), random.uniform(-1, 5)},
                      {random.normal(), random.normal(), random.normal()},
                      static_cast<double>(i % 3)};
    weighted.push_back(sample);
    const int count = i % 3;
    sample.weight = 1.0;
    for (int k = 0; k < count; ++k) repeated.push_back(sample);
  }
  HarmonicTile::Workspace workspace;
  const auto once = tile.solve(weighted, workspace), twice = tile.solve(repeated, workspace);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_LT((once.mean[c] - twice.mean[c]).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((once.variance[c] - twice.variance[c]).cwiseAbs().maxCoeff(), 1e-9);
  }
}

}  // namespace
}  // namespace mstsl
