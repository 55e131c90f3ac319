#include <algorithm>
#include <vector>

#include "mstsl/core/angles.hpp"

#include "built_in_worlds.hpp"
#include "steelwork.hpp"
#include "storey.hpp"

/// An ordinary floor: one corridor, rooms of all widths on both sides, deeper on the north, doors where they
/// happen to be. Nothing repeats.
namespace mstsl::sim {
namespace {

using Eigen::Vector2d;

constexpr double kCorridor_m = 2.2;
constexpr double kPartition_m = 0.12;
constexpr double kDoor_m = 1.0;
constexpr double kNarrowest_m = 2.8, kWidest_m = 7.5;

/// A row of rooms in its own frame: x along the corridor, y = 0 on the corridor's wall, rooms at y > 0.
struct Row {
  Pose2 map_T_row;
  double half_m;   ///< of the corridor
  double depth_m;  ///< of its rooms
};

void add_room(WorldPlan& plan, const Row& row, double from, double to, double door, Random& random) {
  const double left = door - 0.5 * kDoor_m, right = door + 0.5 * kDoor_m, near = kPartition_m,
               far = kPartition_m + row.depth_m, west = from + 0.5 * kPartition_m,
               east = to - 0.5 * kPartition_m;
  std::vector<Vector2d> points;
  for (const Vector2d& p : {Vector2d(from, 0), Vector2d(left, 0), Vector2d(left, near), Vector2d(west, near),
                            Vector2d(west, far), Vector2d(east, far), Vector2d(east, near),
                            Vector2d(right, near), Vector2d(right, 0), Vector2d(to, 0)})
    points.push_back(row.map_T_row * p);
  for (const Segment& piece : polyline(points, false)) plan.walls.push_back(piece);
  add_door_frame(plan.steel, row.map_T_row * Pose2{door, 0, 0}, kDoor_m, random);
  add_radiator(plan.steel, row.map_T_row * Pose2{0.5 * (from + to), far - 0.08, 0}, 1.6, random);

  const Pose2 desk = row.map_T_row * Pose2{random.uniform(west + 0.9, east - 0.9), far - 0.5, 0};
  for (const Segment& piece : box(desk, {random.uniform(0.4, 1.5), 0.6})) plan.walls.push_back(piece);
  add_cabinet(plan.steel, desk, {0.42, 0.6}, 0.6, random);
  const bool east_side = door - from < to - door;  // away from the door
  for (const double share : {0.35, 0.7})
    plan.spots.push_back({ThingKind::kCabinet,
                          row.map_T_row * Pose2{east_side ? east : west, near + share * row.depth_m,
                                                east_side ? radians(90) : radians(-90)},
                          0.5, std::nullopt});
  plan.lanes.push_back(
      {row.map_T_row * Segment{{door, -0.5 * kCorridor_m}, {door, near + 1.6}}, kDoor_m - 0.2});
}

void add_row(WorldPlan& plan, const Row& row, Random& random) {
  for (double from = -row.half_m; from < row.half_m;) {
    double to = from + random.uniform(kNarrowest_m, kWidest_m);
    if (row.half_m - to < kNarrowest_m) to = row.half_m;
    const double door = random.uniform(from + 0.5 * kDoor_m + 0.3, to - 0.5 * kDoor_m - 0.3);
    add_room(plan, row, from, to, door, random);
    from = to;
  }
}

}  // namespace

WorldPlan plan_office(const WorldOptions&, const Vector2d& size_m, Random& random) {
  const double x = 0.5 * size_m.x(), half = 0.5 * kCorridor_m;
  const double rooms_m = size_m.y() - kCorridor_m - 2 * kPartition_m;
  const double north_m = 0.6 * rooms_m, south_m = rooms_m - north_m;
  WorldPlan plan;
  plan.name = "office";
  const double top = half + kPartition_m + north_m + 0.3, bottom = -half - kPartition_m - south_m - 0.3;
  plan.footprint_m = {Vector2d(-x - 0.3, bottom), Vector2d(x + 0.3, top)};
  plan.lanes.push_back({{{-x + 0.8, 0}, {x - 0.8, 0}}, kCorridor_m});
  add_storey(plan, 3.6, random);
  add_row(plan, {{0, half, 0}, x, north_m}, random);
  add_row(plan, {{0, -half, kPi}, x, south_m}, random);
  for (const double side : {-1.0, 1.0}) plan.walls.push_back({{side * x, -half}, {side * x, half}});
  for (double column = -x; column <= x; column += 7.2)
    for (const double y : {-half - 0.2, half + 0.2})
      add_concrete_column(plan.steel, {column, y}, 2.8, random);
  return plan;
}

}  // namespace mstsl::sim
