#include <cmath>
#include <vector>

#include "mstsl/core/angles.hpp"

#include "built_in_worlds.hpp"
#include "storey.hpp"
#include "walls.hpp"

/// Two parallel corridors joined by a third in their middle, as an H; all four limbs are exactly alike.
namespace mstsl::sim {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

constexpr double kWidth_m = 2.4;
constexpr double kBay_m = 3.6;

/// Recessed doors, one a bay, symmetric about the wall's middle.
std::vector<Relief> doors(double length_m) {
  std::vector<Relief> reliefs;
  const int bays = static_cast<int>((length_m - 1.0) / kBay_m);
  for (int i = 0; i < bays; ++i)
    reliefs.push_back({0.5 * length_m + (i + 0.5 - 0.5 * bays) * kBay_m, 1.0, 0.25, true});
  return reliefs;
}

Wall wall_with_doors(const Vector2d& a, const Vector2d& b) { return {a, b, doors((b - a).norm())}; }

/// Half of the boundary, counter-clockwise; the other half is this one turned by 180 deg.
std::vector<Wall> half_boundary(double x, double y) {
  const double in = x - kWidth_m, bar = 0.5 * kWidth_m;
  const Vector2d p0(in, -y), p1(x, -y), p2(x, y), p3(in, y), p4(in, bar), p5(-in, bar), p6(-in, y);
  return {{p0, p1, {}},
          wall_with_doors(p1, p2),
          {p2, p3, {}},
          wall_with_doors(p3, p4),
          wall_with_doors(p4, p5),
          wall_with_doors(p5, p6)};
}

}  // namespace

WorldPlan plan_h_wing(const WorldOptions&, const Vector2d& size_m, Random& random) {
  const double x = 0.5 * size_m.x(), y = 0.5 * size_m.y();
  WorldPlan plan;
  plan.name = "h-wing";
  plan.footprint_m = AlignedBox2d(-0.5 * size_m - Vector2d(0.5, 0.5), 0.5 * size_m + Vector2d(0.5, 0.5));
  std::vector<Wall> walls = half_boundary(x, y);
  const std::vector<Wall> copy = opposite(walls, 0.0, random);
  walls.insert(walls.end(), copy.begin(), copy.end());
  std::vector<Vector2d> points = corners(walls);
  points.pop_back();
  plan.walls = polyline(points, true);
  for (const Wall& wall : walls) furnish(plan, wall, {2.8, 2 * kBay_m, false, 0.3, 2.2}, random);
  const double lane_x = x - 0.5 * kWidth_m, end = y - 1.0;
  plan.lanes = {{{{-lane_x, -end}, {-lane_x, end}}, kWidth_m},
                {{{lane_x, -end}, {lane_x, end}}, kWidth_m},
                {{{-lane_x, 0}, {lane_x, 0}}, kWidth_m}};
  add_storey(plan, kBay_m, random);
  return plan;
}

}  // namespace mstsl::sim
