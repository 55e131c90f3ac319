// Cost of the field map's regression: a car park's survey of the paper's size, by quality and by number of
// fingerprints.
#include <cmath>

#include <benchmark/benchmark.h>

#include "mstsl/core/random.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"
#include "mstsl/magnetic/tile_regression.hpp"

namespace mstsl {
namespace {

constexpr double kLengthScale_m = 0.45, kNoiseRatio = 0.08, kCell_m = 0.05;

/// Lanes a length `lane_m` apart over a square tile and its halo, driven both ways, a sample each `step_m`.
std::vector<TileSample> lanes(double side_m, double halo_m, double lane_m, double step_m) {
  Random random(1);
  const auto value = [&](const Eigen::Vector2d& p) {
    const Eigen::Array2d phase = p.array() / kLengthScale_m;
    Eigen::Array3d field(std::sin(phase.x()), std::cos(phase.y()), std::sin(phase.sum() / 2));
    for (double& component : field) component += random.normal(0, kNoiseRatio);
    return field;
  };
  std::vector<TileSample> samples;
  for (double y = -halo_m; y < side_m + halo_m; y += lane_m)
    for (int direction = 0; direction < 2; ++direction)
      for (double x = -halo_m; x < side_m + halo_m; x += step_m) {
        const Eigen::Vector2d place(x, y + random.normal(0, 0.03));
        samples.push_back({place, value(place), 1.0});
      }
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

/// A whole map of a square of that side, from 39 fingerprints a square metre: 5 m hold 1,000 of them, 160 m a
/// million.
void BM_Map(benchmark::State& state) {
  const double side_m = static_cast<double>(state.range(0)), lane_m = 1.0, per_m2 = 39.0;
  SurveyAnalysis survey;
  for (const TileSample& s : lanes(side_m, 0.0, lane_m, 2.0 / (per_m2 * lane_m)))
    survey.fingerprints.push_back({s.position_m, 7.0 * s.value.matrix(), 0.0, 0});
  FieldHyperparameters& h = survey.hyperparameters.values;
  h.length_scale_m.setConstant(kLengthScale_m);
  h.noise_sd_uT = kNoiseRatio * h.signal_sd_uT;
  survey.calibration = {Eigen::Array3d::Ones(), h.noise_sd_uT, h.signal_sd_uT};
  if (state.range(2) != 0)
    survey.harmonic =
        HarmonicHyperparameters{SourceSide::kBoth, kLengthScale_m / 0.42, 9.0, h.mean_uT, h.noise_sd_uT};
  GridGeometry geometry;
  geometry.resolution_m = kCell_m;
  geometry.columns = geometry.rows = static_cast<int>(side_m / kCell_m);
  const OccupancyGrid square(geometry, CellState::kFree);
  FieldMapOptions options;
  options.threads = Threads{static_cast<int>(state.range(1))};
  for (auto _ : state) benchmark::DoNotOptimize(build_field_map(survey, &square, options).ok());
  const double cells = static_cast<double>(state.iterations()) * static_cast<double>(geometry.size());
  state.counters["s_per_cell"] =
      benchmark::Counter(cells, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["fingerprints"] = static_cast<double>(survey.fingerprints.size());
}
BENCHMARK(BM_Map)
    ->ArgNames({"side_m", "threads", "harmonic"})
    ->ArgsProduct({{5, 16, 51, 160}, {1}, {0}})
    ->Args({51, 2, 0})
    ->Args({16, 1, 1})
    ->Args({51, 1, 1})
    ->Args({51, 2, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace mstsl
