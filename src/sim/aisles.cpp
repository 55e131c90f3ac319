#include <vector>

#include "mstsl/core/angles.hpp"

#include "built_in_worlds.hpp"
#include "steelwork.hpp"

/// Identical aisles between solid shelves, joined by two head aisles: to a lidar every aisle is every other
/// one, also turned by 180 deg. Only steel tells them apart.
namespace mstsl::sim {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

constexpr double kAisle_m = 3.0;
constexpr double kShelf_m = 1.1;  ///< depth of one of the two shelves back to back
constexpr double kModule_m = kAisle_m + 2 * kShelf_m;
constexpr double kHeadAisle_m = 4.0;
constexpr double kBay_m = 2.7;
constexpr double kHeight_m = 5.0;

struct Layout {
  double x, y;  ///< half the inner size
  int aisles, bays;
  double aisle_x(int aisle) const { return (aisle - 0.5 * (aisles - 1)) * kModule_m; }
  double frame_y(int frame) const { return (frame - 0.5 * bays) * kBay_m; }
};

Layout layout_of(const Vector2d& size_m) {
  const int aisles = static_cast<int>(size_m.x() / kModule_m);
  return {0.5 * aisles * kModule_m, 0.5 * size_m.y(), aisles,
          static_cast<int>((size_m.y() - 2 * kHeadAisle_m) / kBay_m)};
}

/// The frames, beams and goods of one shelf whose middle line is x. Goods lie above the lidar's plane.
void add_shelf(WorldPlan& plan, const Layout& l, double x, Random& random) {
  for (int frame = 0; frame <= l.bays; ++frame)
    add_rack_frame(plan.steel, {x, l.frame_y(frame), radians(90)}, kShelf_m - 0.1, kHeight_m, random);
  for (int bay = 0; bay < l.bays; ++bay) {
    for (const double z : {0.2, 1.6, 3.2})
      for (const double side : {-0.5, 0.5})
        add_rack_beam(plan.steel,
                      {{x + side * kShelf_m, l.frame_y(bay)}, {x + side * kShelf_m, l.frame_y(bay + 1)}}, z,
                      random);
    for (const double share : {0.25, 0.75})
      plan.spots.push_back(
          {ThingKind::kHiddenSteel, {x, l.frame_y(bay) + share * kBay_m, radians(90)}, 0.6, std::nullopt});
  }
}

void add_shelves(WorldPlan& plan, const Layout& l, Random& random) {
  const double half_m = 0.5 * l.bays * kBay_m;
  for (int block = 0; block <= l.aisles; ++block) {
    const bool first = block == 0, last = block == l.aisles;
    const double middle = (block - 0.5 * l.aisles) * kModule_m;
    const double from = first ? middle : middle - kShelf_m, to = last ? middle : middle + kShelf_m;
    for (const Segment& piece : box({0.5 * (from + to), 0, 0}, {to - from, 2 * half_m}))
      plan.walls.push_back(piece);
    if (!first) add_shelf(plan, l, middle - 0.5 * kShelf_m, random);
    if (!last) add_shelf(plan, l, middle + 0.5 * kShelf_m, random);
  }
}

}  // namespace

WorldPlan plan_aisles(const WorldOptions&, const Vector2d& size_m, Random& random) {
  const Layout l = layout_of(size_m);
  const AlignedBox2d hall(Vector2d(-l.x, -l.y), Vector2d(l.x, l.y));
  WorldPlan plan;
  plan.name = "aisles";
  plan.footprint_m = AlignedBox2d(hall.min() - Vector2d(0.5, 0.5), hall.max() + Vector2d(0.5, 0.5));
  plan.walls = box({}, hall.sizes());
  add_shelves(plan, l, random);
  const double y = 0.5 * (0.5 * l.bays * kBay_m + l.y);
  for (const double side : {-1.0, 1.0})
    plan.lanes.push_back(
        {{{l.aisle_x(0), side * y}, {l.aisle_x(l.aisles - 1), side * y}}, kHeadAisle_m - 1.0});
  for (int aisle = 0; aisle < l.aisles; ++aisle)
    plan.lanes.push_back({{{l.aisle_x(aisle), -y}, {l.aisle_x(aisle), y}}, kAisle_m});
  add_slab(plan.steel, {}, hall, -0.08, random);
  return plan;
}

}  // namespace mstsl::sim
