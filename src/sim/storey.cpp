#include "storey.hpp"

#include <cmath>

#include "steelwork.hpp"

namespace mstsl::sim {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

void add_storey(WorldPlan& plan, double beam_spacing_m, Random& random) {
  constexpr double kBeside_m = 1.0;  // slabs and beams run on behind the walls
  constexpr double kFloor_m = -0.06, kCeiling_m = 3.2;
  for (const Lane& lane : plan.lanes) {
    const Vector2d along = lane.center.b - lane.center.a;
    const Pose2 start = Pose2::from(lane.center.a, std::atan2(along.y(), along.x()));
    const double half = 0.5 * lane.free_width_m + kBeside_m;
    const AlignedBox2d area(Vector2d(-half, -half), Vector2d(along.norm() + half, half));
    for (const double z : {kFloor_m, kCeiling_m}) {
      add_slab(plan.steel, start, area, z, random);
      add_beams(plan.steel, start, area, z, beam_spacing_m, random);
    }
    for (const double side : {-0.3, 0.35})
      add_tray(plan.steel,
               start * Segment{{0, side * lane.free_width_m}, {along.norm(), side * lane.free_width_m}}, 2.6,
               random);
  }
}

}  // namespace mstsl::sim
