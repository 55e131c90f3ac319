#include <cmath>
#include <cstddef>

#include "mstsl/sim/lidar.hpp"

namespace mstsl::sim {

using Eigen::Vector2d;

People::People(const World& world, const PeopleOptions& options, const Random& random) : options_(options) {
  double lanes_m = 0.0;
  for (const Lane& lane : world.lanes()) lanes_m += length(lane.center);
  const double expected = lanes_m * options.per_100m / 100.0;
  Random own = random;
  const auto count =
      static_cast<std::size_t>(expected) + (own.chance(expected - std::floor(expected)) ? 1 : 0);
  for (std::size_t i = 0; i < count && !world.lanes().empty(); ++i) {
    const Lane& lane = world.lanes()[own.index(world.lanes().size())];
    const Vector2d along = (lane.center.b - lane.center.a).normalized();
    const double beside_m = own.uniform(-0.3, 0.3) * lane.free_width_m;
    const Vector2d aside = beside_m * Vector2d(-along.y(), along.x());
    walkers_.push_back({{lane.center.a + aside, lane.center.b + aside},
                        own.uniform(0.0, 2.0 * length(lane.center)),
                        options.speed_m_s * own.uniform(0.7, 1.3)});
  }
}

std::vector<Leg> People::legs(double seconds, const Vector2d& robot_m, double radius_m) const {
  constexpr double kHalfStride_m = 0.3, kHalfGap_m = 0.1;  // adult gait
  std::vector<Leg> legs;
  for (const Walker& walker : walkers_) {
    const double whole_m = length(walker.path);
    const double walked_m = walker.phase_m + walker.speed_m_s * seconds;
    const double there_and_back = std::fmod(walked_m, 2.0 * whole_m);
    const double along_m = there_and_back < whole_m ? there_and_back : 2.0 * whole_m - there_and_back;
    const Vector2d at = point_along(walker.path, along_m / whole_m);
    const double away_m = (at - robot_m).norm();
    if (away_m > radius_m || away_m < options_.keep_away_m) continue;
    const Vector2d ahead = (walker.path.b - walker.path.a) / whole_m, aside(-ahead.y(), ahead.x());
    const double swing_m = kHalfStride_m * std::sin(walked_m / kHalfStride_m);
    for (const double side : {-1.0, 1.0})
      legs.push_back({at + side * (swing_m * ahead + kHalfGap_m * aside), options_.leg_radius_m});
  }
  return legs;
}

}  // namespace mstsl::sim
