// What a scan costs the joint method, searching and tracking, and what switching on costs, on a building that
// is repeated side by side until it is as large as wanted: the hypotheses grow with the area, as they do in
// halls of equal aisles. With two threads; the baseline hears the same events.
#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "mstsl/localize/baselines/global_scan.hpp"
#include "mstsl/localize/joint/joint.hpp"
#include "mstsl/sim/drive.hpp"
#include "mstsl/sim/occupancy_map.hpp"
#include "mstsl/sim/run.hpp"

namespace mstsl {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// A building, and what a robot's sensors say on a drive through it.
struct Drive {
  sim::World world;
  OccupancyGrid occupancy;
  FieldMap field;
  sim::RobotOptions robot;
  std::vector<SensorEvent> events;
};

/// The true field on the free cells: the cost does not depend on how a map was made.
FieldMap field_of(const sim::World& world, const OccupancyGrid& occupancy) {
  FieldMap field;
  field.geometry = occupancy.geometry();
  const std::size_t cells = field.geometry.size();
  field.mean_uT.assign(cells, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  field.variance_uT2 = field.mean_uT;
  field.supported.assign(cells, 0);
  for (std::size_t i = 0; i < cells; ++i) {
    const Cell cell = field.geometry.cell(i);
    if (occupancy[cell] != CellState::kFree) continue;
    const Eigen::Vector2d at = field.geometry.center_of(cell);
    field.mean_uT[i] = world.field_uT({at.x(), at.y(), 0.7}).cast<float>();
    field.variance_uT2[i].setConstant(0.5F);
    field.supported[i] = 1;
  }
  return field;
}

const Drive& drive() {
  static const Drive made = [] {
    sim::World world = sim::make_world("corridor", {}, Random(1)).value();
    OccupancyGrid occupancy = sim::occupancy_map(world);
    FieldMap field = field_of(world, occupancy);
    Drive drive{std::move(world), std::move(occupancy), std::move(field), {}, {}};
    drive.robot.lidar.rate_hz = 10.0;
    sim::RunOptions run;
    run.length_m = 30.0;
    const sim::Route route = sim::random_run(drive.world, run, Random(2)).value();
    sim::drive(drive.world, drive.robot, route, Stamp{}, Random(3),
               {[&](const SensorEvent& event) { drive.events.push_back(event); }, {}});
    return drive;
  }();
  return made;
}

/// `side` x `side` copies of the building.
std::pair<OccupancyGrid, FieldMap> repeated(const Drive& drive, int side) {
  GridGeometry large = drive.occupancy.geometry();
  const GridGeometry small = large;
  large.columns *= side;
  large.rows *= side;
  OccupancyGrid occupancy(large, CellState::kUnknown);
  FieldMap field;
  field.geometry = large;
  field.mean_uT.resize(large.size());
  field.variance_uT2.resize(large.size());
  field.supported.resize(large.size());
  for (std::size_t i = 0; i < large.size(); ++i) {
    const Cell cell = large.cell(i), from{cell.column % small.columns, cell.row % small.rows};
    const std::size_t k = small.index(from);
    occupancy[cell] = drive.occupancy[from];
    field.mean_uT[i] = drive.field.mean_uT[k];
    field.variance_uT2[i] = drive.field.variance_uT2[k];
    field.supported[i] = drive.field.supported[k];
  }
  return {std::move(occupancy), std::move(field)};
}

struct Costs {
  std::vector<double> searching_ms, tracking_ms;
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Feeds the whole drive; the cost of each scan with all readings since the last, by whether a pose was
/// known.
template <Localizer L>
Costs costs_of(L& localizer, const std::vector<SensorEvent>& events) {
  Costs costs;
  Clock::time_point start = Clock::now();
  for (const SensorEvent& event : events) {
    feed(localizer, event);
    if (!std::holds_alternative<LaserScan>(event)) continue;
    (localizer.estimate().map_T_base ? costs.tracking_ms : costs.searching_ms).push_back(ms_since(start));
    start = Clock::now();
  }
  return costs;
}

void report(benchmark::State& state, const Costs& costs, double free_m2) {
  // The first scan is that of switching on: start_up reports it.
  const std::vector<double> after(costs.searching_ms.begin() + (costs.searching_ms.empty() ? 0 : 1),
                                  costs.searching_ms.end());
  state.counters["free_m2"] = free_m2;
  state.counters["first_ms"] = costs.searching_ms.empty() ? 0.0 : costs.searching_ms.front();
  state.counters["search_95_ms"] = quantile(after, 0.95);
  state.counters["search_max_ms"] = quantile(after, 1.0);
  state.counters["track_50_ms"] = quantile(costs.tracking_ms, 0.5);
  state.counters["track_95_ms"] = quantile(costs.tracking_ms, 0.95);
}

double free_m2(const OccupancyGrid& occupancy) {
  const double side_m = occupancy.geometry().resolution_m;
  return side_m * side_m * static_cast<double>(count(occupancy, CellState::kFree));
}

/// 1 to 8 copies of the building to a side, each once: a drive is long enough to be timed by itself.
void on_growing_buildings(benchmark::internal::Benchmark* benchmark) {
  for (const int side : {1, 2, 4, 8}) benchmark->Arg(side);
  benchmark->Unit(benchmark::kMillisecond)->Iterations(1)->UseRealTime();
}

void joint_drive(benchmark::State& state) {
  auto [occupancy, field] = repeated(drive(), static_cast<int>(state.range(0)));
  const double area_m2 = free_m2(occupancy);
  const auto maps = joint::make_maps(make_localization_maps(std::move(occupancy), std::move(field)).value());
  JointOptions options;
  options.bank.threads = {2};
  Costs costs;
  for (auto _ : state) {
    Joint localizer(maps, drive().robot.rig, options);
    costs = costs_of(localizer, drive().events);
  }
  report(state, costs, area_m2);
}
BENCHMARK(joint_drive)->Apply(on_growing_buildings);

void global_scan_drive(benchmark::State& state) {
  auto [occupancy, field] = repeated(drive(), 1);
  const double area_m2 = free_m2(occupancy);
  const auto maps = make_localization_maps(std::move(occupancy), std::move(field)).value();
  Costs costs;
  for (auto _ : state) {
    GlobalScan localizer(maps, drive().robot.rig, {});
    costs = costs_of(localizer, drive().events);
  }
  report(state, costs, area_m2);
}
BENCHMARK(global_scan_drive)->Unit(benchmark::kMillisecond)->Iterations(1)->UseRealTime();

/// From maps in memory to the first hypotheses.
void start_up(benchmark::State& state) {
  const auto [occupancy, field] = repeated(drive(), static_cast<int>(state.range(0)));
  JointOptions options;
  options.bank.threads = {2};
  for (auto _ : state) {
    const auto maps = joint::make_maps(make_localization_maps(occupancy, field, {.threads = {2}}).value());
    Joint localizer(maps, drive().robot.rig, options);
    for (std::size_t i = 0; localizer.bank().modes().empty() && i < drive().events.size(); ++i)
      feed(localizer, drive().events[i]);
    state.counters["hypotheses"] = static_cast<double>(localizer.bank().modes().size());
  }
  state.counters["free_m2"] = free_m2(occupancy);
}
BENCHMARK(start_up)->Apply(on_growing_buildings);

}  // namespace
}  // namespace mstsl
