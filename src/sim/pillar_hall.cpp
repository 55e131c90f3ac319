#include <vector>

#include "mstsl/core/angles.hpp"

#include "built_in_worlds.hpp"
#include "steelwork.hpp"
#include "walls.hpp"

/// A bare hall with a regular grid of pillars: every field between four pillars looks like every other one,
/// and the whole is symmetric under 180 deg.
namespace mstsl::sim {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

constexpr double kGrid_m = 6.0;
constexpr double kPillar_m = 0.6;
constexpr double kLane_m = 3.0;
constexpr double kCeiling_m = 3.6;

struct Layout {
  int columns, rows;  ///< fields between pillars, along x and y
  double x(double field) const { return (field + 0.5 - 0.5 * columns) * kGrid_m; }
  double y(double field) const { return (field + 0.5 - 0.5 * rows) * kGrid_m; }
};

void add_pillars(WorldPlan& plan, const Layout& l, Random& random) {
  for (int i = 1; i < l.columns; ++i)
    for (int j = 1; j < l.rows; ++j) {
      const Vector2d at(l.x(i - 0.5), l.y(j - 0.5));
      for (const Segment& piece : box(Pose2::from(at, 0), {kPillar_m, kPillar_m}))
        plan.walls.push_back(piece);
      add_concrete_column(plan.steel, at, kCeiling_m, random);
      // Switch boxes and hose reels on the pillars, above the lidar's plane.
      plan.spots.push_back({ThingKind::kHiddenSteel,
                            Pose2::from(at, radians(90) * static_cast<double>(random.index(4))), 0.5,
                            std::nullopt});
    }
}

void add_lanes(WorldPlan& plan, const Layout& l) {
  for (int i = 0; i < l.columns; ++i)
    plan.lanes.push_back({{{l.x(i), l.y(0)}, {l.x(i), l.y(l.rows - 1)}}, kLane_m});
  for (int j = 0; j < l.rows; ++j)
    plan.lanes.push_back({{{l.x(0), l.y(j)}, {l.x(l.columns - 1), l.y(j)}}, kLane_m});
}

}  // namespace

WorldPlan plan_pillar_hall(const WorldOptions&, const Vector2d& size_m, Random& random) {
  const Layout l{static_cast<int>(size_m.x() / kGrid_m), static_cast<int>(size_m.y() / kGrid_m)};
  const Vector2d half(0.5 * kGrid_m * l.columns, 0.5 * kGrid_m * l.rows);
  const AlignedBox2d hall(-half, half);
  WorldPlan plan;
  plan.name = "pillar-hall";
  plan.footprint_m = AlignedBox2d(-half - Vector2d(0.5, 0.5), half + Vector2d(0.5, 0.5));
  const std::vector<Vector2d> around{-half, {half.x(), -half.y()}, half, {-half.x(), half.y()}, -half};
  for (std::size_t i = 0; i + 1 < around.size(); ++i) {
    plan.walls.push_back({around[i], around[i + 1]});
    furnish(plan, {around[i], around[i + 1], {}}, {kCeiling_m, kGrid_m, false, 0.0, 3.0}, random);
  }
  add_pillars(plan, l, random);
  add_lanes(plan, l);
  for (const double z : {-0.06, kCeiling_m + 0.4}) {
    add_slab(plan.steel, {}, hall, z, random);
    add_beams(plan.steel, {}, hall, z, kGrid_m, random);
  }
  return plan;
}

}  // namespace mstsl::sim
