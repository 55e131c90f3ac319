#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

#include "harmonic/dense.hpp"
#include "harmonic/tile.hpp"

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

/// Poles of random strength and sign on sheets half a depth (1 m) below or above, or both: the field that the
/// covariance stands for, made without it. Spread 1 for B_z.
class PoleSheets {
 public:
  PoleSheets(SourceSide side, Random& random) {
    for (int i = 0; i < 4000; ++i)
      poles_.push_back({{random.uniform(-12, 18), random.uniform(-12, 18)},
                        side == SourceSide::kBoth ? (i % 2 == 0 ? 0.5 : -0.5)
                                                  : (side == SourceSide::kBelow ? 0.5 : -0.5),
                        random.normal()});
    // Variance of B_z under a sheet of n poles a square metre: n pi / (2 h^2), h = 0.5.
    scale_ = 1.0 / std::sqrt(4000.0 / 900.0 * kPi / 2 / 0.25);
  }
  Eigen::Array3d at(const Eigen::Vector2d& p) const {
    Eigen::Array3d field = Eigen::Array3d::Zero();
    for (const Pole& pole : poles_) {
      const Eigen::Array3d d(p.x() - pole.position_m.x(), p.y() - pole.position_m.y(), pole.below_m);
      field += pole.strength * d / std::pow(d.square().sum(), 1.5);
    }
    return scale_ * field;
  }

 private:
  struct Pole {
    Eigen::Vector2d position_m;
    double below_m, strength;
  };
  std::vector<Pole> poles_;
  double scale_;
};

/// A tile's posterior against that of the dense solution from everything three depths around.
Deviations deviations(const Regime& r, RegressionQuality quality) {
  HarmonicTileOptions options;
  options.field.side = r.side;
  options.field.depth_m = 1.0;
  options.field.signal_sd_uT = 1.0;
  options.field.noise_sd_uT = Eigen::Array3d::Constant(r.noise);
  options.cell_m = 0.25;
  options.samples_per_m2 = r.per_depth / r.lane_depths;
  options.quality = quality;
  const HarmonicTile tile(options);
  const double side_m = tile.cells() * options.cell_m, around_m = 3.0;
  Random random(7);
  const PoleSheets sheets(r.side, random);
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

TEST_P(HarmonicTileRegimes, FollowTheDenseSolution) {
  const Deviations fast = deviations(GetParam(), RegressionQuality::kFast),
                   exact = deviations(GetParam(), RegressionQuality::kExact);
  RecordProperty("fast", std::to_string(fast.mean_of_noise));
  std::printf("%s fast %.4f %.4f exact %.4f %.4f\n", GetParam().name, fast.mean_of_noise, fast.variance_share,
              exact.mean_of_noise, exact.variance_share);
  EXPECT_LT(fast.mean_of_noise, 0.1);
  EXPECT_LT(fast.variance_share, 0.05);
  EXPECT_LT(exact.mean_of_noise, 0.03);
  EXPECT_LT(exact.variance_share, 0.02);
}

INSTANTIATE_TEST_SUITE_P(All, HarmonicTileRegimes,
                         testing::Values(Regime{"below", SourceSide::kBelow, 0.4, 0.1, 8},
                                         Regime{"above", SourceSide::kAbove, 0.4, 0.1, 8},
                                         Regime{"both", SourceSide::kBoth, 0.4, 0.1, 8},
                                         Regime{"little_noise", SourceSide::kBoth, 0.4, 0.02, 8},
                                         Regime{"much_noise", SourceSide::kBelow, 0.4, 0.5, 8},
                                         Regime{"lanes_far_apart", SourceSide::kBoth, 1.0, 0.1, 10}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace mstsl
