#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "mstsl/grid/distance_field.hpp"
#include "mstsl/scan/branch_and_bound.hpp"
#include "mstsl/scan/line_fit.hpp"
#include "mstsl/scan/local_map.hpp"
#include "mstsl/scan/match_submap.hpp"
#include "mstsl/scan/refine.hpp"

#include "segment_world.hpp"

namespace mstsl {
namespace {

/// A corridor loop of 60 x 22 m, 2.2 m wide, with rooms' doors as niches every 4 m: the size of the paper's
/// office.
test::Segments corridor_loop() {
  test::Segments walls =
      test::joined(test::rectangle(-30, -11, 30, 11), test::rectangle(-27.8, -8.8, 27.8, 8.8));
  for (double x = -26; x < 27; x += 4) {
    walls = test::joined(walls, test::rectangle(x, 8.6, x + 0.9, 8.8));
    walls = test::joined(walls, test::rectangle(x + 1.3, -8.8, x + 2.2, -8.6));
  }
  return walls;
}

constexpr Pose2 kTruth{-5.0, 9.9, 0.1};

struct Scene {
  Scene() : map(test::drawn(corridor_loop(), geometry)) {
    Random random(1);
    const LaserScan scan = test::scan_of(corridor_loop(), kTruth, random, {.noise_m = 0.01});
    returns = beam_returns(scan, Eigen::Isometry3d::Identity());
    all_points = end_points(returns);
    points = at_most(thinned(all_points, 0.1), 200);
  }
  static constexpr GridGeometry geometry{
      .resolution_m = 0.05, .columns = 1240, .rows = 480, .map_T_grid = {-31, -12, 0}};
  MatchMap map;
  std::vector<BeamReturn> returns;
  PointSet all_points;
  PointSet points;
};

const Scene& scene() {
  static const Scene made;
  return made;
}

void distance_field(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(DistanceField(scene().map.occupancy, 0.3));
}
BENCHMARK(distance_field)->Unit(benchmark::kMillisecond);

void match_map(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(MatchMap(scene().map.occupancy));
}
BENCHMARK(match_map)->Unit(benchmark::kMillisecond);

void thin_a_scan(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(thinned(scene().all_points, 0.1));
}
BENCHMARK(thin_a_scan)->Unit(benchmark::kMicrosecond);

void line_fit(benchmark::State& state) {
  Random random(2);
  for (auto _ : state) benchmark::DoNotOptimize(fit_line(scene().all_points, {}, random));
}
BENCHMARK(line_fit)->Unit(benchmark::kMicrosecond);

/// Window: plus and minus so many metres (first argument, in dm) and degrees.
void branch_and_bound(benchmark::State& state) {
  const double reach_m = 0.1 * static_cast<double>(state.range(0));
  const SearchWindow window{{kTruth.x + 0.31, kTruth.y - 0.22, kTruth.yaw + 0.05},
                            {reach_m, reach_m},
                            radians(static_cast<double>(state.range(1)))};
  for (auto _ : state) benchmark::DoNotOptimize(search_poses(scene().map.pyramid, scene().points, window));
}
BENCHMARK(branch_and_bound)
    ->Args({5, 10})
    ->Args({10, 10})
    ->Args({30, 20})
    ->Args({30, 180})
    ->Unit(benchmark::kMillisecond);

void search_whole_map(benchmark::State& state) {
  const SearchWindow window = SearchWindow::whole(Scene::geometry);
  for (auto _ : state) benchmark::DoNotOptimize(search_poses(scene().map.pyramid, scene().points, window));
}
BENCHMARK(search_whole_map)->Unit(benchmark::kMillisecond);

void refine(benchmark::State& state) {
  const Pose2 initial{kTruth.x + 0.03, kTruth.y - 0.04, kTruth.yaw + 0.01};
  const PosePrior prior = PosePrior::isotropic(initial, 0.1, 0.05);
  for (auto _ : state)
    benchmark::DoNotOptimize(refine_pose(scene().map.field, scene().points, initial, prior));
}
BENCHMARK(refine)->Unit(benchmark::kMicrosecond);

void score(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(confidence_score(scene().map.occupancy, scene().all_points, kTruth));
}
BENCHMARK(score)->Unit(benchmark::kMicrosecond);

/// One scan into a local map: aligned only (0), or drawn as well (1).
void local_map(benchmark::State& state) {
  LocalMapOptions options;
  if (state.range(0) == 1) options.keyframe_distance_m = 0;
  LocalMap map(options);
  for (auto _ : state) map.insert(scene().returns, Pose2{});
}
BENCHMARK(local_map)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mstsl
