#include <cmath>
#include <vector>

#include "mstsl/core/angles.hpp"

#include "built_in_worlds.hpp"
#include "steelwork.hpp"
#include "walls.hpp"

/// A parking deck: aisles across its length between two head aisles, bays both sides, a regular grid of
/// pillars, long sides half open to the air.
namespace mstsl::sim {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

constexpr double kAisle_m = 6.5;
constexpr double kBayDepth_m = 5.0;
constexpr double kBayWidth_m = 2.5;
constexpr double kHeadAisle_m = 6.0;
constexpr int kBaysPerPillar = 3;
constexpr double kPillar_m = 0.5;
constexpr double kPillarSetBack_m = 0.8;
constexpr double kModule_m = kAisle_m + 2 * kBayDepth_m;
constexpr double kCeiling_m = 2.6;

struct Layout {
  double x, y;  ///< half the inner size
  int modules;  ///< aisles
  int bays;     ///< along one side of an aisle
  double aisle_x(int module) const { return (module - 0.5 * (modules - 1)) * kModule_m; }
  double bay_y(double bay) const { return (bay + 0.5 - 0.5 * bays) * kBayWidth_m; }
};

Layout layout_of(const Vector2d& size_m) {
  const int modules = static_cast<int>(size_m.x() / kModule_m);
  const int bays = static_cast<int>((size_m.y() - 2 * kHeadAisle_m) / kBayWidth_m);
  return {0.5 * size_m.x(), 0.5 * size_m.y(), modules, bays};
}

/// Parapet panels and the gaps between them along a long side.
void add_open_side(WorldPlan& plan, const Wall& side, double asymmetry_m, Random& random) {
  constexpr double kPanel_m = 5.0, kGap_m = 3.2, kThick_m = 0.2;
  for (double at = 0.5 * std::fmod(side.length_m() + kGap_m, kPanel_m + kGap_m);
       at + kPanel_m <= side.length_m(); at += kPanel_m + kGap_m) {
    const Pose2 middle =
        side.frame_at(at + 0.5 * kPanel_m + random.normal(0, asymmetry_m)) * Pose2{0, -0.5 * kThick_m, 0};
    for (const Segment& piece : box(middle, {kPanel_m, kThick_m})) plan.walls.push_back(piece);
    add_tray(plan.steel, middle * Segment{{-0.5 * kPanel_m, 0}, {0.5 * kPanel_m, 0}}, 1.0,
             random);  // hand rail
  }
}

void add_closed_side(WorldPlan& plan, Wall side, Random& random) {
  side.reliefs = {{0.3 * side.length_m(), 2.4, 1.2, false}, {0.7 * side.length_m(), 1.1, 0.25, true}};
  for (const Segment& piece : polyline(corners({side}), false)) plan.walls.push_back(piece);
  furnish(plan, side, {kCeiling_m, 7.5, false, 0.0, 6.0}, random);
}

/// What a lidar sees through the gaps: a retaining wall on one side, trees on the other.
void add_surroundings(WorldPlan& plan, const Layout& l, Random& random) {
  plan.walls.push_back({{-l.x - 4, l.y + 9}, {l.x + 4, l.y + 8}});
  for (double x = -l.x; x < l.x; x += 6.5) {
    const Vector2d at(x + random.uniform(-1, 1), -l.y - random.uniform(4, 9));
    for (const Segment& piece : box(Pose2::from(at, random.uniform(0, kPi)), {0.35, 0.35}))
      plan.walls.push_back(piece);
  }
}

void add_pillars(WorldPlan& plan, const Layout& l, double asymmetry_m, Random& random) {
  for (int module = 0; module < l.modules; ++module)
    for (const double side : {-1.0, 1.0})
      for (int bay = 0; bay <= l.bays; bay += kBaysPerPillar) {
        const Vector2d at(l.aisle_x(module) + side * (0.5 * kAisle_m + kPillarSetBack_m) +
                              random.normal(0, 0.5 * asymmetry_m),
                          l.bay_y(bay - 0.5) + random.normal(0, 0.5 * asymmetry_m));
        for (const Segment& piece : box(Pose2::from(at, 0), {kPillar_m, kPillar_m}))
          plan.walls.push_back(piece);
        add_concrete_column(plan.steel, at, kCeiling_m, random);
      }
}

void add_bays(WorldPlan& plan, const Layout& l, double occupancy) {
  for (int module = 0; module < l.modules; ++module)
    for (const double side : {-1.0, 1.0})
      for (int bay = 0; bay < l.bays; ++bay) {
        const Vector2d middle(l.aisle_x(module) + side * (0.5 * kAisle_m + 0.5 * kBayDepth_m), l.bay_y(bay));
        plan.spots.push_back(
            {ThingKind::kCar, Pose2::from(middle, side > 0 ? 0.0 : kPi), occupancy, std::nullopt});
      }
}

void add_lanes(WorldPlan& plan, const Layout& l) {
  const double y = l.y - 0.5 * kHeadAisle_m;
  for (const double side : {-1.0, 1.0})
    plan.lanes.push_back(
        {{{l.aisle_x(0) - 2, side * y}, {l.aisle_x(l.modules - 1) + 2, side * y}}, kHeadAisle_m - 1.0});
  for (int module = 0; module < l.modules; ++module)
    plan.lanes.push_back({{{l.aisle_x(module), -y}, {l.aisle_x(module), y}}, kAisle_m - 1.0});
}

void add_deck(WorldPlan& plan, const Layout& l, Random& random) {
  const AlignedBox2d area(Vector2d(-l.x, -l.y), Vector2d(l.x, l.y));
  for (const double z : {-0.05, kCeiling_m + 0.4}) {
    add_slab(plan.steel, {}, area, z, random);
    add_beams(plan.steel, {0, 0, radians(90)}, {Vector2d(-l.y, -l.x), Vector2d(l.y, l.x)}, z,
              kBaysPerPillar * kBayWidth_m / 2, random);
  }
  for (int module = 0; module < l.modules; ++module)  // sprinkler and lighting along the aisles
    add_tray(plan.steel, {{l.aisle_x(module) + 0.8, -l.y}, {l.aisle_x(module) + 0.8, l.y}}, 2.3, random);
}

}  // namespace

WorldPlan plan_carpark(const WorldOptions& options, const Vector2d& size_m, Random& random) {
  const Layout l = layout_of(size_m);
  WorldPlan plan;
  plan.name = "carpark";
  plan.footprint_m = AlignedBox2d(-0.5 * size_m, 0.5 * size_m);
  const Vector2d sw(-l.x, -l.y), se(l.x, -l.y), ne(l.x, l.y), nw(-l.x, l.y);
  add_open_side(plan, {sw, se, {}}, options.asymmetry_m, random);
  add_closed_side(plan, {se, ne, {}}, random);
  add_open_side(plan, {ne, nw, {}}, options.asymmetry_m, random);
  add_closed_side(plan, {nw, sw, {}}, random);
  add_surroundings(plan, l, random);
  add_pillars(plan, l, options.asymmetry_m, random);
  add_bays(plan, l, options.car_occupancy);
  add_lanes(plan, l);
  add_deck(plan, l, random);
  return plan;
}

}  // namespace mstsl::sim
