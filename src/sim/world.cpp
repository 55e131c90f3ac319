#include "mstsl/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "built_in_worlds.hpp"
#include "things.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;

constexpr double kClearanceCell_m = 0.1;

std::vector<Segment> all_surfaces(const WorldPlan& plan) {
  std::vector<Segment> segments = plan.walls;
  for (const Spot& spot : plan.spots)
    if (spot.thing) segments.insert(segments.end(), spot.thing->outline.begin(), spot.thing->outline.end());
  return segments;
}

SteelField all_steel(const WorldPlan& plan) {
  std::vector<PolePair> pairs;
  const auto take = [&](Rod rod) {
    rod.remanence_A_per_m *= plan.magnetisation;
    pairs.push_back(magnetised(rod, plan.earth));
  };
  for (const Rod& rod : plan.steel) take(rod);
  for (const Spot& spot : plan.spots)
    if (spot.thing)
      for (const Rod& rod : spot.thing->steel) take(rod);
  return SteelField(plan.earth, std::move(pairs));
}

GridGeometry geometry_over(const Eigen::AlignedBox2d& area_m, double cell_m) {
  const Vector2d size = area_m.sizes() / cell_m;
  return {cell_m, static_cast<int>(std::ceil(size.x() - 1e-9)), static_cast<int>(std::ceil(size.y() - 1e-9)),
          Pose2::from(area_m.min(), 0)};
}

bool is_ground(const WorldPlan& plan, const Vector2d& point_m) {
  return plan.footprint_m.contains(point_m) &&
         (!plan.ground || state_at(*plan.ground, point_m) == CellState::kFree);
}

/// Spreads from the lanes over all ground that is far enough from the surfaces.
Grid<float> clearance_of(const WorldPlan& plan, const SegmentIndex& surfaces) {
  Grid<float> clearance(geometry_over(plan.footprint_m, kClearanceCell_m), 0.0f);
  std::vector<bool> seen(clearance.geometry().size(), false);
  std::vector<Cell> open;
  const auto visit = [&](Cell cell) {
    if (!clearance.contains(cell) || seen[clearance.geometry().index(cell)]) return;
    seen[clearance.geometry().index(cell)] = true;
    const Vector2d center = clearance.geometry().center_of(cell);
    const double distance =
        is_ground(plan, center) ? surfaces.clearance(center, World::kMaxClearance_m) : 0.0;
    if (distance < World::kRobotClearance_m) return;
    clearance[cell] = static_cast<float>(distance);
    open.push_back(cell);
  };
  for (const Lane& lane : plan.lanes) {
    const int steps = 1 + static_cast<int>(length(lane.center) / kClearanceCell_m);
    for (int i = 0; i <= steps; ++i)
      visit(clearance.geometry().cell_at(point_along(lane.center, static_cast<double>(i) / steps)));
  }
  while (!open.empty()) {
    const Cell cell = open.back();
    open.pop_back();
    for (const Cell step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}})
      visit({cell.column + step.column, cell.row + step.row});
  }
  return clearance;
}

Grid<std::uint8_t> lane_cells(const WorldPlan& plan, const Grid<float>& clearance) {
  Grid<std::uint8_t> on_lane(clearance.geometry(), 0);
  for (std::size_t i = 0; i < on_lane.values().size(); ++i) {
    if (clearance.values()[i] <= 0) continue;
    const Vector2d center = clearance.geometry().center_of(clearance.geometry().cell(i));
    on_lane.values()[i] = std::any_of(plan.lanes.begin(), plan.lanes.end(), [&](const Lane& lane) {
      return distance(center, lane.center) <= 0.5 * lane.free_width_m;
    });
  }
  return on_lane;
}

}  // namespace

World::World(WorldPlan plan)
    : plan_(std::move(plan)),
      surfaces_(all_surfaces(plan_)),
      field_(all_steel(plan_)),
      clearance_m_(clearance_of(plan_, surfaces_)),
      on_lane_(lane_cells(plan_, clearance_m_)) {}

namespace {

/// A spot decided anew that looks as it did: its steel is that of the new thing, its outline the old one's.
void settle_steel(Spot& spot, Random& random) {
  std::vector<Segment> outline = spot.thing ? spot.thing->outline : std::vector<Segment>{};
  settle(spot, random);
  if (!spot.thing && !outline.empty()) spot.thing.emplace();
  if (spot.thing) spot.thing->outline = std::move(outline);
}

}  // namespace

World on_another_day(const World& world, double moved_fraction, const Random& random, Change change) {
  WorldPlan plan = world.plan();
  for (std::size_t i = 0; i < plan.spots.size(); ++i) {
    Random own = random.fork(i);
    if (!own.chance(moved_fraction)) continue;
    change == Change::kThings ? settle(plan.spots[i], own) : settle_steel(plan.spots[i], own);
  }
  return World(std::move(plan));
}

}  // namespace mstsl::sim
