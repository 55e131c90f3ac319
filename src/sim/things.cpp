#include "things.hpp"

#include <Eigen/Core>

#include "mstsl/core/angles.hpp"

#include "steelwork.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;

Pose2 shifted(const Pose2& map_T_spot, double sigma_m, double sigma_rad, Random& random) {
  return map_T_spot *
         Pose2{random.normal(0, sigma_m), random.normal(0, sigma_m), random.normal(0, sigma_rad)};
}

/// A car's outline at bumper height: a box with its corners cut.
std::vector<Segment> car_outline(const Pose2& map_T_car, const Vector2d& size_m) {
  constexpr double kCut_m = 0.25;
  const double x = 0.5 * size_m.x(), y = 0.5 * size_m.y();
  std::vector<Vector2d> points;
  for (const Vector2d& p : {Vector2d(-x, -y + kCut_m), Vector2d(-x + kCut_m, -y), Vector2d(x - kCut_m, -y),
                            Vector2d(x, -y + kCut_m), Vector2d(x, y - kCut_m), Vector2d(x - kCut_m, y),
                            Vector2d(-x + kCut_m, y), Vector2d(-x, y - kCut_m)})
    points.push_back(map_T_car * p);
  return polyline(points, true);
}

Thing make_car(const Pose2& map_T_spot, Random& random) {
  const Vector2d size(random.uniform(3.8, 4.8), random.uniform(1.7, 1.9));
  const double backwards = random.chance(0.3) ? kPi : 0.0;
  const Pose2 map_T_car = shifted(map_T_spot * Pose2{0, 0, backwards}, 0.12, radians(1.0), random);
  Thing car{car_outline(map_T_car, size), {}};
  add_car(car.steel, map_T_car, size, random);
  return car;
}

Thing make_cabinet(const Pose2& map_T_spot, Random& random) {
  const Vector2d size(random.uniform(0.6, 1.2), 0.4);
  const Pose2 at = map_T_spot * Pose2{random.normal(0, 0.1), 0.5 * size.y() + 0.01, 0};
  Thing cabinet{box(at, size), {}};
  add_cabinet(cabinet.steel, at, 0.95 * size, random.uniform(1.2, 2.0), random);
  return cabinet;
}

Thing make_trolley(const Pose2& map_T_spot, Random& random) {
  const Vector2d size(random.uniform(0.4, 0.8), random.uniform(0.35, 0.45));
  const Pose2 at = shifted(map_T_spot * Pose2{0, 0.5 * size.y() + 0.08, 0}, 0.03, radians(4.0), random);
  Thing trolley{box(at, size), {}};
  add_cabinet(trolley.steel, at, size, 0.9, random);
  return trolley;
}

Thing make_pallet(const Pose2& map_T_spot, Random& random) {
  const Vector2d size(random.uniform(0.7, 0.85), random.uniform(0.9, 1.1));
  const Pose2 at = shifted(map_T_spot, 0.05, radians(2.0), random);
  Thing pallet{box(at, size), {}};
  constexpr double kSheetGoods = 0.35, kHeavyGoods = 0.15;  // shares; the rest is not magnetic
  const double goods = random.uniform();
  if (goods < kSheetGoods)
    add_cabinet(pallet.steel, at, 0.8 * size, random.uniform(0.4, 1.2), random);
  else if (goods < kSheetGoods + kHeavyGoods)
    add_machine(pallet.steel, at.position(), 0.8, random);
  return pallet;
}

Thing make_hidden_steel(const Pose2& map_T_spot, Random& random) {
  Thing furniture;
  const Pose2 at = shifted(map_T_spot, 0.2, radians(3.0), random);
  constexpr double kShareOfMachines = 0.15;
  if (random.chance(kShareOfMachines)) {
    add_machine(furniture.steel, at * Vector2d(0, 1.0), 1.0, random);
  } else {
    add_cabinet(furniture.steel, at * Pose2{0, 0.25, 0}, {random.uniform(0.6, 1.2), 0.45},
                random.uniform(0.8, 2.0), random);
  }
  return furniture;
}

}  // namespace

Thing make_thing(ThingKind kind, const Pose2& map_T_spot, Random& random) {
  switch (kind) {
    case ThingKind::kCar:
      return make_car(map_T_spot, random);
    case ThingKind::kCabinet:
      return make_cabinet(map_T_spot, random);
    case ThingKind::kTrolley:
      return make_trolley(map_T_spot, random);
    case ThingKind::kPallet:
      return make_pallet(map_T_spot, random);
    case ThingKind::kHiddenSteel:
      return make_hidden_steel(map_T_spot, random);
  }
  return {};
}

void settle(Spot& spot, Random& random) {
  spot.thing.reset();
  if (random.chance(spot.occupancy)) spot.thing = make_thing(spot.kind, spot.map_T_spot, random);
}

}  // namespace mstsl::sim
