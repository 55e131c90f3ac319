#include "mstsl/magnetic/tile_regression.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"
#include "mstsl/magnetic/gaussian_process.hpp"

#include "test_support.hpp"

namespace mstsl {
namespace {

using test::must;

struct Case {
  const char* name;
  double length_scale_m, noise_ratio, lane_m, step_m;
  double passes = 1.0;  ///< each sample counts so often
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

/// Lanes around a tile at 0 .. side_m, each driven both ways, and a smooth field with the covariance's own
/// roughness.
std::vector<TileSample> survey(const Case& c, double side_m, double halo_m, std::uint64_t seed) {
  Random random(seed);
  struct Wave {
    double kx, ky, phase, amplitude;
  };
  std::array<std::vector<Wave>, 3> waves;
  for (auto& component : waves)
    for (int i = 0; i < 100; ++i)
      component.push_back({random.normal() / c.length_scale_m, random.normal() / c.length_scale_m,
                           random.uniform(0, 6.28), random.normal() * std::sqrt(2.0 / 100)});
  std::vector<TileSample> samples;
  for (double y = -halo_m + 0.3 * c.lane_m; y < side_m + halo_m; y += c.lane_m)
    for (int direction = 0; direction < 2; ++direction) {
      const double offset = random.normal(0, 0.03);
      for (double x = -halo_m + random.uniform(0, c.step_m); x < side_m + halo_m; x += c.step_m) {
        TileSample s{{x, y + offset}, Eigen::Array3d::Zero(), 1.0};
        for (int k = 0; k < 3; ++k) {
          for (const Wave& w : waves[static_cast<std::size_t>(k)])
            s.value[k] += w.amplitude * std::cos(w.kx * x + w.ky * s.position_m.y() + w.phase);
          s.value[k] += random.normal(0, c.noise_ratio);
        }
        samples.push_back(s);
      }
    }
  return samples;
}

struct Errors {
  double mean_rms = 0.0;      ///< as a share of the noise
  double variance_max = 0.0;  ///< as a share of the variance of a reading
};

/// The exact solution at the tile's cells from all samples.
ExactRegression<Sum<SquaredExponential, WhiteNoise>>::Prediction solve_exactly(
    const Case& c, int cells, double cell_m, const std::vector<TileSample>& samples) {
  std::vector<Eigen::Vector2d> points, centers;
  Eigen::MatrixXd values(static_cast<Eigen::Index>(samples.size()), 3);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    points.push_back(samples[i].position_m);
    values.row(static_cast<Eigen::Index>(i)) = samples[i].value.transpose();
  }
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column)
      centers.push_back({(column + 0.5) * cell_m, (row + 0.5) * cell_m});
  const auto kernel = SquaredExponential{1.0, c.length_scale_m} + WhiteNoise{c.noise_ratio};
  return must(fit_exactly(kernel, points, values, false)).predict(centers);
}

template <typename Exact>
Errors compare(const TileRegression::Posterior& posterior, const Exact& exact, double noise_ratio) {
  Errors errors;
  double sum = 0.0;
  const double noise2 = noise_ratio * noise_ratio;
  const auto cells = posterior.variance.rows();
  for (Eigen::Index row = 0, i = 0; row < cells; ++row)
    for (Eigen::Index column = 0; column < cells; ++column, ++i) {
      for (int k = 0; k < 3; ++k)
        sum += std::pow(posterior.mean[static_cast<std::size_t>(k)](column, row) - exact.mean(i, k), 2);
      const double relative = (posterior.variance(column, row) + noise2) / (exact.variance(i) + noise2) - 1.0;
      errors.variance_max = std::max(errors.variance_max, std::abs(relative));
    }
  errors.mean_rms = std::sqrt(sum / (3.0 * static_cast<double>(cells * cells))) / noise_ratio;
  return errors;
}

class TileRegressionAgainstTheExactSolution : public ::testing::TestWithParam<Case> {};

TEST_P(TileRegressionAgainstTheExactSolution, StaysWithinItsStatedError) {
  const Case c = GetParam();
  constexpr int kCells = 10;
  const double cell_m = 0.3 * c.length_scale_m;
  Case all_passes = c;
  all_passes.noise_ratio /= std::sqrt(c.passes);
  auto samples = survey(all_passes, kCells * cell_m, 7.0 * c.length_scale_m, 1);
  const auto exact = solve_exactly(all_passes, kCells, cell_m, samples);
  for (TileSample& sample : samples) sample.weight = c.passes;
  const double dense_per_m2 = 2.0 * c.passes / (std::min(c.lane_m, c.length_scale_m) * c.step_m);
  for (const auto quality : {RegressionQuality::kFast, RegressionQuality::kExact}) {
    const TileRegression tile({c.length_scale_m, c.noise_ratio, cell_m, kCells, dense_per_m2, quality});
    const Errors e = compare(tile.solve(samples), exact, c.noise_ratio);
    const bool is_exact = quality == RegressionQuality::kExact;
    EXPECT_LT(e.mean_rms, is_exact ? 0.01 : 0.04);
    EXPECT_LT(e.variance_max, is_exact ? 0.005 : 0.01);
  }
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) { return info.param.name; }

// Steps along a lane are longer than the 5 cm of a survey, to keep the exact solution small: it is the
// information per area that matters.
// clang-format off
INSTANTIATE_TEST_SUITE_P(Surveys, TileRegressionAgainstTheExactSolution, ::testing::Values(
    Case{"AsInTheIssue", 0.45, 0.08, 0.7, 0.15},
    Case{"DenseLanes",   0.45, 0.08, 0.3, 0.30},
    Case{"SparseLanes",  0.45, 0.08, 2.0, 0.05},
    Case{"LongScale",    3.0,  0.08, 2.0, 2.00},
    Case{"ShortScale",   0.2,  0.08, 0.3, 0.07},
    Case{"LittleNoise",  0.45, 0.01, 0.5, 0.20},
    Case{"MuchNoise",    0.45, 1.0,  0.5, 0.20},
    Case{"SparseLanesDrivenOften", 0.45, 0.08, 2.0, 0.10, 100.0},
    Case{"DrivenAThousandTimes",   0.45, 0.08, 0.7, 0.15, 1000.0},
    Case{"LittleNoiseDrivenOften", 0.45, 0.01, 0.7, 0.15, 10.0}), name_of);
// clang-format on

TEST(TileRegression, MeanAtSamplesIsThatOfTheCellsTheyLieIn) {
  TileOptions options;
  options.cell_m = 0.25;
  const TileRegression tile(options);
  std::vector<TileSample> samples = {{{-0.3, 1.0}, {5.0, 5.0, 5.0}, 1.0}};  // outside: not told
  for (int column = 0; column < tile.cells(); ++column)
    samples.push_back(
        {{(column + 0.5) * options.cell_m, 1.125}, {std::sin(column), std::cos(column), 1.0}, 1.0});
  const auto posterior = tile.solve(samples);
  EXPECT_EQ(posterior.mean_at_samples.row(0).norm(), 0.0);
  for (int column = 0; column < tile.cells(); ++column)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(posterior.mean_at_samples(column + 1, c),
                  posterior.mean[static_cast<std::size_t>(c)](column, 4), 1e-6);
}

}  // namespace
}  // namespace mstsl
