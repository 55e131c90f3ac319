#include <cmath>
#include <vector>

#include "mstsl/core/angles.hpp"

#include "built_in_worlds.hpp"
#include "steelwork.hpp"
#include "walls.hpp"

/// One corridor with equal rooms on both sides, their doors open.
namespace mstsl::sim {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

constexpr double kCorridor_m = 2.2;
constexpr double kRoomWidth_m = 3.6;
constexpr double kPartition_m = 0.12;
constexpr double kDoor_m = 0.95;
constexpr double kHeight_m = 2.8;

struct Layout {
  double x, y;     ///< half the outer size
  int rooms;       ///< on one side
  double depth_m;  ///< of a room
  double room_x(int room) const { return (room + 0.5 - 0.5 * rooms) * kRoomWidth_m; }
};

Layout layout_of(const Vector2d& size_m) {
  const double depth = 0.5 * (size_m.y() - kCorridor_m) - kPartition_m;
  return {0.5 * size_m.x(), 0.5 * size_m.y(), static_cast<int>(size_m.x() / kRoomWidth_m), depth};
}

/// Where a room's door is, across the room: alternating, so that doors come in pairs.
double door_shift(int room) { return (room % 2 == 0 ? 1.0 : -1.0) * (0.5 * kRoomWidth_m - 0.9); }

/// The frame of a room's door: x along the corridor's wall, y into the corridor. `side` is +1 north, -1
/// south.
Pose2 door_frame(const Layout& l, int room, double side) {
  return {l.room_x(room) + door_shift(room), side * 0.5 * kCorridor_m, side > 0 ? kPi : 0.0};
}

/// Desk legs, a drawer unit and the open door's leaf, in the room's frame (origin at its middle, y to the
/// window).
void furnish_room(WorldPlan& plan, const Pose2& map_T_room, const Pose2& map_T_door, double depth_m,
                  Random& random) {
  const Vector2d desk(random.uniform(-0.3, 0.3), 0.5 * depth_m - random.uniform(1.0, 1.5));
  for (const double x : {-0.75, 0.75})
    for (const double y : {-0.35, 0.35})
      for (const Segment& leg : box(map_T_room * Pose2{desk.x() + x, desk.y() + y, 0}, {0.05, 0.05}))
        plan.walls.push_back(leg);
  const Pose2 drawers = map_T_room * Pose2{desk.x() + (random.chance(0.5) ? 0.5 : -0.5), desk.y(), 0};
  for (const Segment& piece : box(drawers, {0.42, 0.6})) plan.walls.push_back(piece);
  add_cabinet(plan.steel, drawers, {0.42, 0.6}, 0.6, random);

  const Pose2 hinge = map_T_door * Pose2{0.5 * kDoor_m - 0.03, -kPartition_m - 0.01,
                                         radians(-90) + random.uniform(radians(-1), radians(25))};
  plan.walls.push_back(hinge * Segment{{0, 0}, {0.88, 0}});
  add_radiator(plan.steel, map_T_room * Pose2{0, 0.5 * depth_m - 0.08, 0}, 1.6, random);
  add_door_frame(plan.steel, map_T_door, kDoor_m, random);
}

void add_room(WorldPlan& plan, const Layout& l, int room, double side, Random& random) {
  const Pose2 door = door_frame(l, room, side);
  const Pose2 map_T_room{l.room_x(room), side * (0.5 * kCorridor_m + kPartition_m + 0.5 * l.depth_m),
                         side > 0 ? 0.0 : kPi};
  const double half = 0.5 * (kRoomWidth_m - kPartition_m), near = -0.5 * l.depth_m;
  // From the door's one jamb round the room to the other; the door lies at `shift` in the room's frame.
  const double shift = (inverse(map_T_room) * door.position()).x(), gap = 0.5 * kDoor_m;
  std::vector<Vector2d> points;
  for (const Vector2d& p :
       {Vector2d(shift + gap, near - kPartition_m), Vector2d(shift + gap, near), Vector2d(half, near),
        Vector2d(half, -near), Vector2d(-half, -near), Vector2d(-half, near), Vector2d(shift - gap, near),
        Vector2d(shift - gap, near - kPartition_m)})
    points.push_back(map_T_room * p);
  for (const Segment& piece : polyline(points, false)) plan.walls.push_back(piece);
  furnish_room(plan, map_T_room, door, l.depth_m, random);

  // Cupboards along the wall away from the door, and a chair or box that never stands twice in one place.
  const double away = shift > 0 ? -1.0 : 1.0;
  for (const double along : {-0.25, 0.25})
    plan.spots.push_back({ThingKind::kCabinet,
                          map_T_room * Pose2{away * half, along * l.depth_m, away * radians(90)}, 0.5,
                          std::nullopt});
  plan.spots.push_back(
      {ThingKind::kTrolley, map_T_room * Pose2{away * 0.7, 0.0, radians(90)}, 0.5, std::nullopt});
  plan.lanes.push_back(
      {{door * Vector2d(0, 0.5 * kCorridor_m), door * Vector2d(0, -kPartition_m - 1.6)}, kDoor_m - 0.2});
}

/// The corridor's walls between the doors, and its two ends.
void add_corridor(WorldPlan& plan, const Layout& l) {
  const double half = 0.5 * kCorridor_m;
  for (const double side : {-1.0, 1.0}) {
    double from = -l.x;
    for (int room = 0; room < l.rooms; ++room) {
      const double door = door_frame(l, room, side).x;
      plan.walls.push_back({{from, side * half}, {door - 0.5 * kDoor_m, side * half}});
      from = door + 0.5 * kDoor_m;
    }
    plan.walls.push_back({{from, side * half}, {l.x, side * half}});
    plan.walls.push_back({{side * l.x, -half}, {side * l.x, half}});
  }
}

void add_structure(WorldPlan& plan, const Layout& l, Random& random) {
  const AlignedBox2d area(Vector2d(-l.x, -l.y), Vector2d(l.x, l.y));
  for (const double z : {-0.06, 3.2}) {
    add_slab(plan.steel, {}, area, z, random);
    add_beams(plan.steel, {}, area, z, kRoomWidth_m, random);
  }
  for (const double y : {-0.5, 0.6}) add_tray(plan.steel, {{-l.x, y}, {l.x, y}}, 2.6, random);
  for (double x = -l.x; x <= l.x; x += 2 * kRoomWidth_m)
    for (const double y : {-l.y, -0.5 * kCorridor_m - 0.2, 0.5 * kCorridor_m + 0.2, l.y})
      add_concrete_column(plan.steel, {x, y}, kHeight_m, random);
}

}  // namespace

WorldPlan plan_office_wing(const WorldOptions&, const Vector2d& size_m, Random& random) {
  const Layout l = layout_of(size_m);
  WorldPlan plan;
  plan.name = "office-wing";
  plan.footprint_m = AlignedBox2d(-0.5 * size_m - Vector2d(0.3, 0.3), 0.5 * size_m + Vector2d(0.3, 0.3));
  plan.lanes.push_back({{{-l.x + 0.8, 0}, {l.x - 0.8, 0}}, kCorridor_m});
  add_corridor(plan, l);
  for (int room = 0; room < l.rooms; ++room)
    for (const double side : {-1.0, 1.0}) add_room(plan, l, room, side, random);
  add_structure(plan, l, random);
  return plan;
}

}  // namespace mstsl::sim
