#include <cmath>
#include <vector>

#include "mstsl/core/angles.hpp"

#include "built_in_worlds.hpp"
#include "steelwork.hpp"
#include "storey.hpp"
#include "walls.hpp"

/// An office loop after the real corridor loop (61 x 22 m): two long corridors, two short ones with a lift
/// lobby, all four ends running on as stubs. One half is the other turned by 180 deg, but for centimetres as
/// built.
namespace mstsl::sim {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

constexpr double kLongWidth_m = 2.4;
constexpr double kShortWidth_m = 2.6;
constexpr double kStub_m = 4.0;
constexpr double kLobbyWidth_m = 4.5;
constexpr double kLobbyDepth_m = 3.2;
constexpr double kDoorWidth_m = 1.0;
constexpr double kDoorDepth_m = 0.28;
constexpr double kBay_m = 7.2;  ///< structural grid: two offices

/// Shallow piers between the windows.
std::vector<Relief> piers(double length_m) {
  std::vector<Relief> reliefs;
  const double spacing = 0.5 * kBay_m;
  for (double at = 0.5 * std::fmod(length_m, spacing) + 0.5 * spacing; at < length_m - 0.5; at += spacing)
    reliefs.push_back({at, 0.25, -0.06, false});
  return reliefs;
}

/// Pairs of recessed office doors, one pair a bay.
std::vector<Relief> doors(double length_m) {
  std::vector<Relief> reliefs;
  const int bays = static_cast<int>((length_m - 1.0) / kBay_m);
  const double margin = 0.5 * (length_m - bays * kBay_m);
  for (int i = 0; i < bays; ++i)
    for (const double side : {-1.0, 1.0})
      reliefs.push_back({margin + (i + 0.5) * kBay_m + side * 0.75, kDoorWidth_m, kDoorDepth_m, true});
  return reliefs;
}

std::vector<Relief> lobby(double length_m) { return {{0.5 * length_m, kLobbyWidth_m, kLobbyDepth_m, false}}; }

struct Layout {
  double x, y;              ///< half the outer size
  double outer_x, inner_x;  ///< the short corridor's outer and inner wall
  double inner_y;           ///< the long corridor's inner wall
};

Layout layout_of(const Vector2d& size_m) {
  const double x = 0.5 * size_m.x(), y = 0.5 * size_m.y();
  return {x, y, x - kStub_m, x - kStub_m - kShortWidth_m, y - kLongWidth_m};
}

/// The outer boundary's southern and eastern half, counter-clockwise.
std::vector<Wall> outer_half(const Layout& l) {
  const Vector2d p0(-l.x, -l.y), p1(l.x, -l.y), p2(l.x, -l.inner_y), p3(l.outer_x, -l.inner_y),
      p4(l.outer_x, l.inner_y), p5(l.x, l.inner_y), p6(l.x, l.y);
  const Relief stub_door{0.5 * kLongWidth_m, 1.6, 0.12, true};
  return {{p0, p1, piers((p1 - p0).norm())},
          {p1, p2, {stub_door}},
          {p2, p3, {{2.0, kDoorWidth_m, kDoorDepth_m, true}}},
          {p3, p4, lobby((p4 - p3).norm())},
          {p4, p5, {{2.0, kDoorWidth_m, kDoorDepth_m, true}}},
          {p5, p6, {stub_door}}};
}

/// The inner block's southern and western half, clockwise.
std::vector<Wall> inner_half(const Layout& l) {
  const Vector2d q0(l.inner_x, -l.inner_y), q1(-l.inner_x, -l.inner_y), q2(-l.inner_x, l.inner_y);
  const double side = (q2 - q1).norm();
  return {{q0, q1, doors((q1 - q0).norm())},
          {q1,
           q2,
           {{0.22 * side, kDoorWidth_m, 0.15, true},
            {0.5 * side, 3.0, 0.4, false},
            {0.78 * side, kDoorWidth_m, 0.15, true}}}};
}

void add_ring(WorldPlan& plan, std::vector<Wall> half, const WorldOptions& options,
              const Furnishing& furnishing, Random& random) {
  const std::vector<Wall> copy = opposite(half, options.asymmetry_m, random);
  half.insert(half.end(), copy.begin(), copy.end());
  std::vector<Vector2d> points = corners(half);
  points.pop_back();  // the ring's end is its start
  for (const Segment& piece : polyline(points, true)) plan.walls.push_back(piece);
  for (const Wall& wall : half) furnish(plan, wall, furnishing, random);
}

void add_corridor_steel(WorldPlan& plan, Random& random) {
  add_storey(plan, 0.5 * kBay_m, random);
  constexpr double kShaft_m = 2.0;
  for (const double side : {-1.0, 1.0})
    for (const double y : {-1.2, 1.2}) {
      const double behind = 0.5 * plan.footprint_m.sizes().x() - kStub_m + kLobbyDepth_m + 1.2;
      add_machine(plan.steel, {side * behind, y}, kShaft_m, random);  // lifts
    }
}

/// Places against the walls of the lobbies and corridors where something may stand.
void add_spots(WorldPlan& plan, const Layout& l) {
  for (const double side : {0.0, kPi}) {
    const Pose2 turned{0, 0, side};
    const auto against = [&](ThingKind kind, const Pose2& pose, double occupancy) {
      plan.spots.push_back({kind, turned * pose, occupancy, std::nullopt});
    };
    against(ThingKind::kCabinet, {l.outer_x + 1.6, -0.5 * kLobbyWidth_m, 0}, 0.5);
    against(ThingKind::kTrolley, {l.outer_x + kLobbyDepth_m, 1.0, radians(90)}, 0.4);
    against(ThingKind::kTrolley, {0.35 * l.x, -l.inner_y, kPi}, 0.3);
    against(ThingKind::kCabinet, {-0.4 * l.x, -l.inner_y, kPi}, 0.3);
    against(ThingKind::kTrolley, {l.x, -l.y + 0.5, radians(90)}, 0.4);
  }
}

}  // namespace

WorldPlan plan_corridor(const WorldOptions& options, const Vector2d& size_m, Random& random) {
  const Layout l = layout_of(size_m);
  WorldPlan plan;
  plan.name = "corridor";
  plan.footprint_m = AlignedBox2d(-0.5 * size_m - Vector2d(0.5, 0.5), 0.5 * size_m + Vector2d(0.5, 0.5));
  const double y = l.y - 0.5 * kLongWidth_m, x = l.outer_x - 0.5 * kShortWidth_m, end = l.x - 1.0;
  plan.lanes = {{{{-end, -y}, {end, -y}}, kLongWidth_m},
                {{{-end, y}, {end, y}}, kLongWidth_m},
                {{{x, -y}, {x, y}}, kShortWidth_m},
                {{{-x, -y}, {-x, y}}, kShortWidth_m}};
  add_ring(plan, outer_half(l), options, {2.8, kBay_m, false, 0.35, 0.0}, random);
  add_ring(plan, inner_half(l), options, {2.8, kBay_m, false, 0.0, 2.2}, random);
  add_corridor_steel(plan, random);
  add_spots(plan, l);
  return plan;
}

WorldPlan plan_symmetric_loop(const WorldOptions& options, const Vector2d& size_m, Random& random) {
  WorldOptions exact = options;
  exact.asymmetry_m = 0.0;
  WorldPlan plan = plan_corridor(exact, size_m, random);
  plan.name = "symmetric-loop";
  // What a lidar could see would break the symmetry; what it cannot see stays.
  std::erase_if(plan.spots, [](const Spot& spot) { return spot.kind != ThingKind::kHiddenSteel; });
  return plan;
}

}  // namespace mstsl::sim
