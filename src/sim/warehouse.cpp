#include <cmath>
#include <vector>

#include "mstsl/core/angles.hpp"

#include "built_in_worlds.hpp"
#include "steelwork.hpp"
#include "walls.hpp"

/// A hall of double pallet racks with identical aisles between two head aisles.
namespace mstsl::sim {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

constexpr double kAisle_m = 3.0;
constexpr double kRackDepth_m = 1.1;  ///< one of the two back to back
constexpr double kBay_m = 2.7;
constexpr double kHeadAisle_m = 4.5;
constexpr double kPost_m = 0.1;
constexpr double kRackHeight_m = 5.0;
constexpr double kModule_m = kAisle_m + 2 * kRackDepth_m;

struct Layout {
  double x, y;  ///< half the inner size
  int aisles, bays;
  double aisle_x(int aisle) const { return (aisle - 0.5 * (aisles - 1)) * kModule_m; }
  double frame_y(int frame) const { return (frame - 0.5 * bays) * kBay_m; }
};

Layout layout_of(const Vector2d& size_m) {
  return {0.5 * size_m.x(), 0.5 * size_m.y(), static_cast<int>((size_m.x() - 2 * kRackDepth_m) / kModule_m),
          static_cast<int>((size_m.y() - 2 * kHeadAisle_m) / kBay_m)};
}

/// One row of frames, bays and pallets whose middle line is x.
void add_rack(WorldPlan& plan, const Layout& l, double x, const WorldOptions& options, Random& random) {
  for (int frame = 0; frame <= l.bays; ++frame) {
    const Pose2 middle{x + random.normal(0, 0.2 * options.asymmetry_m),
                       l.frame_y(frame) + random.normal(0, 0.2 * options.asymmetry_m), radians(90)};
    for (const double side : {-0.5, 0.5})
      for (const Segment& piece :
           box(middle * Pose2{0, side * (kRackDepth_m - kPost_m), 0}, {kPost_m, kPost_m}))
        plan.walls.push_back(piece);
    add_rack_frame(plan.steel, middle, kRackDepth_m - kPost_m, kRackHeight_m, random);
  }
  constexpr double kPalletsPerBay = 3;
  constexpr double kGoods = 0.65;  // share of floor places with goods
  for (int bay = 0; bay < l.bays; ++bay) {
    for (const double z : {1.6, 3.2, 4.8})
      for (const double side : {-0.5, 0.5})
        add_rack_beam(
            plan.steel,
            {{x + side * kRackDepth_m, l.frame_y(bay)}, {x + side * kRackDepth_m, l.frame_y(bay + 1)}}, z,
            random);
    for (int i = 0; i < kPalletsPerBay; ++i) {
      const double y = l.frame_y(bay) + (i + 0.5) * kBay_m / kPalletsPerBay;
      plan.spots.push_back({ThingKind::kPallet, {x, y, radians(90)}, kGoods, std::nullopt});
    }
  }
}

void add_hall(WorldPlan& plan, const Layout& l, const WorldOptions& options, Random& random) {
  const Vector2d sw(-l.x, -l.y), se(l.x, -l.y), ne(l.x, l.y);
  std::vector<Wall> half{{sw, se, {}}, {se, ne, {}}};
  for (double at = 6.0; at < half[0].length_m() - 3.0; at += 12.0)
    half[0].reliefs.push_back({at, 3.0, 0.4, true});  // docks
  half[1].reliefs.push_back({0.5 * half[1].length_m(), 1.1, 0.2, true});
  const std::vector<Wall> copy = opposite(half, options.asymmetry_m, random);
  half.insert(half.end(), copy.begin(), copy.end());
  std::vector<Vector2d> points = corners(half);
  points.pop_back();
  for (const Segment& piece : polyline(points, true)) plan.walls.push_back(piece);
  for (const Wall& wall : half) furnish(plan, wall, {7.0, 6.0, true, 0.0, 0.0}, random);
}

void add_lanes(WorldPlan& plan, const Layout& l) {
  const double y = l.y - 0.5 * kHeadAisle_m, x = l.aisle_x(l.aisles - 1);
  for (const double side : {-1.0, 1.0})
    plan.lanes.push_back({{{-x, side * y}, {x, side * y}}, kHeadAisle_m - 1.0});
  for (int aisle = 0; aisle < l.aisles; ++aisle)
    plan.lanes.push_back({{{l.aisle_x(aisle), -y}, {l.aisle_x(aisle), y}}, kAisle_m});
}

}  // namespace

WorldPlan plan_warehouse(const WorldOptions& options, const Vector2d& size_m, Random& random) {
  const Layout l = layout_of(size_m);
  WorldPlan plan;
  plan.name = "warehouse";
  plan.footprint_m = AlignedBox2d(-0.5 * size_m - Vector2d(0.5, 0.5), 0.5 * size_m + Vector2d(0.5, 0.5));
  add_hall(plan, l, options, random);
  for (int aisle = 0; aisle < l.aisles; ++aisle)
    for (const double side : {-1.0, 1.0})
      add_rack(plan, l, l.aisle_x(aisle) + side * 0.5 * (kAisle_m + kRackDepth_m), options, random);
  add_lanes(plan, l);
  add_slab(plan.steel, {}, AlignedBox2d(Vector2d(-l.x, -l.y), Vector2d(l.x, l.y)), -0.08, random);
  return plan;
}

}  // namespace mstsl::sim
