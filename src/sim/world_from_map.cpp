#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "mstsl/grid/outline.hpp"
#include "mstsl/sim/world.hpp"

#include "built_in_worlds.hpp"
#include "map_lanes.hpp"
#include "steelwork.hpp"
#include "things.hpp"
#include "walls.hpp"

namespace mstsl::sim {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

/// Walls shorter than this get no furniture of their own: they are frames, posts and noise of the map.
constexpr double kWall_m = 1.2;

Eigen::AlignedBox2d extent_of(const OccupancyGrid& map) {
  const GridGeometry& g = map.geometry();
  AlignedBox2d extent;
  for (const double x : {0.0, static_cast<double>(g.columns)})
    for (const double y : {0.0, static_cast<double>(g.rows)}) extent.extend(g.to_map({x, y}));
  return extent;
}

/// The wall turned so that the free side is on its left, if one side is free.
std::optional<Wall> facing_free_space(const OccupancyGrid& map, const Segment& segment) {
  constexpr double kBeside_m = 0.3;
  for (const Wall& wall : {Wall{segment.a, segment.b, {}}, Wall{segment.b, segment.a, {}}}) {
    const Pose2 middle = wall.frame_at(0.5 * wall.length_m());
    if (state_at(map, middle * Vector2d(0, kBeside_m)) == CellState::kFree) return wall;
  }
  return std::nullopt;
}

/// A door frame about every so many metres of wall: a map does not show which recess is a door.
void add_doors(WorldPlan& plan, const Wall& wall, Random& random) {
  constexpr double kSpacing_m = 4.0, kDoor_m = 1.0;
  for (double at = kSpacing_m * random.uniform(0.2, 1.0); at + 0.5 * kDoor_m < wall.length_m();
       at += kSpacing_m * random.uniform(0.5, 1.5))
    add_door_frame(plan.steel, wall.frame_at(at) * Pose2{0, -0.1, 0}, kDoor_m, random);
}

void add_steel(WorldPlan& plan, Random& random) {
  for (const Segment& segment : plan.walls) {
    if (length(segment) < kWall_m) continue;
    const auto wall = facing_free_space(*plan.ground, segment);
    if (!wall) continue;
    furnish(plan, *wall, {2.8, 6.0, false, 0.2, 2.2}, random);
    add_doors(plan, *wall, random);
  }
  for (const Lane& lane : plan.lanes) {
    const Vector2d along = lane.center.b - lane.center.a;
    const Pose2 start = Pose2::from(lane.center.a, std::atan2(along.y(), along.x()));
    const double half = 0.5 * lane.free_width_m + 1.0;
    const AlignedBox2d area(Vector2d(-1.0, -half), Vector2d(along.norm() + 1.0, half));
    for (const double z : {-0.06, 3.2}) {
      add_slab(plan.steel, start, area, z, random);
      add_beams(plan.steel, start, area, z, 3.6, random);
    }
    add_tray(plan.steel,
             start * Segment{{0, 0.3 * lane.free_width_m}, {along.norm(), 0.3 * lane.free_width_m}}, 2.6,
             random);
  }
}

/// Lanes that can be reached from the longest one.
std::vector<Lane> connected(const WorldPlan& plan) {
  WorldPlan probe = plan;
  probe.lanes = {*std::max_element(plan.lanes.begin(), plan.lanes.end(), [](const Lane& p, const Lane& q) {
    return length(p.center) < length(q.center);
  })};
  const World world(std::move(probe));
  const auto reached = [&](const Vector2d& point) {
    const Cell cell = world.clearance_m().geometry().cell_at(point);
    return world.clearance_m().contains(cell) && world.clearance_m()[cell] > 0;
  };
  std::vector<Lane> lanes;
  for (const Lane& lane : plan.lanes)
    if (reached(point_along(lane.center, 0.02)) && reached(point_along(lane.center, 0.98)))
      lanes.push_back(lane);
  return lanes;
}

}  // namespace

Result<World> world_from_map(const OccupancyGrid& map, const WorldOptions& options, const Random& random) {
  WorldPlan plan;
  plan.name = "map";
  plan.earth = options.earth;
  plan.magnetisation = options.magnetisation;
  plan.ground = map;
  plan.footprint_m = extent_of(map);
  for (const Polygon& polygon : occupied_outlines(map))
    for (const Segment& piece : polyline(polygon, true)) plan.walls.push_back(piece);
  plan.axis_yaw_rad = main_direction(plan.walls);
  plan.lanes = lanes_of_map(map, SegmentIndex(plan.walls), plan.axis_yaw_rad);
  if (!plan.lanes.empty()) plan.lanes = connected(plan);
  if (plan.lanes.empty())
    return Error(
        "the map has no free space wide and long enough to drive along (at least 0.8 m by 3 m, all of its "
        "cells "
        "free); check its free and occupied thresholds");
  Random building = random.fork(kBuildingStream);
  add_steel(plan, building);
  const Random things = random.fork(kThingsStream);
  for (std::size_t i = 0; i < plan.spots.size(); ++i) {
    Random own = things.fork(i);
    settle(plan.spots[i], own);
  }
  return World(std::move(plan));
}

}  // namespace mstsl::sim
