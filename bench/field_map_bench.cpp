// Cost of the field map's regression: a car park's survey of the paper's size, by quality and by number of
// fingerprints.
#include <cmath>

#include <benchmark/benchmark.h>

#include "mstsl/core/random.hpp"
#include "mstsl/magnetic/tile_regression.hpp"

namespace mstsl {
namespace {

constexpr double kLengthScale_m = 0.45, kNoiseRatio = 0.08, kCell_m = 0.05;

/// Lanes a length `lane_m` apart over a square tile and its halo, driven both ways, a sample each `step_m`.
std::vector<TileSample> lanes(double side_m, double halo_m, double lane_m, double step_m) {
  Random random(1);
  std::vector<TileSample> samples;
  for (double y = -halo_m; y < side_m + halo_m; y += lane_m)
    for (int direction = 0; direction < 2; ++direction)
      for (double x = -halo_m; x < side_m + halo_m; x += step_m)
        samples.push_back({{x, y + random.normal(0, 0.03)},
                           {std::sin(x / kLengthScale_m), std::cos(y / kLengthScale_m), random.normal()},
                           1.0});
  return samples;
}

/// One tile of the survey in the issue: 118,688 fingerprints on 1.23 million cells are 38.6 a square metre.
void BM_Tile(benchmark::State& state) {
  const auto quality = state.range(0) == 0 ? RegressionQuality::kFast : RegressionQuality::kExact;
  const double per_m2 = static_cast<double>(state.range(1));
  const double lane_m = 1.0;
  const TileRegression tile({kLengthScale_m, kNoiseRatio, kCell_m, 0, per_m2, quality});
  const auto samples = lanes(tile.cells() * kCell_m, tile.halo_m(), lane_m, 2.0 / (per_m2 * lane_m));
  TileRegression::Workspace workspace;
  for (auto _ : state) benchmark::DoNotOptimize(tile.solve(samples, workspace));
  const double cells = static_cast<double>(state.iterations()) * tile.cells() * tile.cells();
  state.counters["s_per_cell"] =
      benchmark::Counter(cells, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["rank"] = tile.rank();
  state.counters["halo"] = tile.halo_m() / kLengthScale_m;
}
BENCHMARK(BM_Tile)
    ->ArgNames({"exact", "per_m2"})
    ->ArgsProduct({{0, 1}, {4, 39, 400}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mstsl
