#include "walls.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mstsl/core/angles.hpp"

#include "steelwork.hpp"

namespace mstsl::sim {

using Eigen::Vector2d;

Pose2 Wall::frame_at(double along_m) const {
  const Vector2d direction = (b - a).normalized();
  return Pose2::from(a + along_m * direction, std::atan2(direction.y(), direction.x()));
}

std::vector<Vector2d> corners(const std::vector<Wall>& walls) {
  std::vector<Vector2d> points;
  for (const Wall& wall : walls) {
    points.push_back(wall.a);
    for (const Relief& relief : wall.reliefs) {
      const Pose2 middle = wall.frame_at(relief.at_m);
      const double half = 0.5 * relief.width_m;
      points.push_back(middle * Vector2d(-half, 0));
      points.push_back(middle * Vector2d(-half, -relief.depth_m));
      points.push_back(middle * Vector2d(half, -relief.depth_m));
      points.push_back(middle * Vector2d(half, 0));
    }
  }
  if (!walls.empty()) points.push_back(walls.back().b);
  return points;
}

std::vector<Wall> opposite(const std::vector<Wall>& walls, double asymmetry_m, Random& random) {
  std::vector<Wall> copies;
  for (Wall wall : walls) {
    wall.a = -wall.a;
    wall.b = -wall.b;
    for (Relief& relief : wall.reliefs) {
      relief.at_m += random.normal(0, asymmetry_m);
      relief.width_m += random.normal(0, 0.5 * asymmetry_m);
      relief.depth_m += random.normal(0, 0.5 * asymmetry_m);
    }
    copies.push_back(wall);
  }
  return copies;
}

namespace {

void add_columns(WorldPlan& plan, const Wall& wall, const Furnishing& furnishing, Random& random) {
  constexpr double kBehind_m = 0.25;
  const double spacing = furnishing.column_spacing_m;
  for (double at = 0.5 * std::fmod(wall.length_m(), spacing); at <= wall.length_m(); at += spacing) {
    const Vector2d foot = wall.frame_at(at) * Vector2d(0, -kBehind_m);
    furnishing.steel_columns ? add_steel_column(plan.steel, foot, furnishing.height_m, random)
                             : add_concrete_column(plan.steel, foot, furnishing.height_m, random);
  }
}

/// No recess opens at a place.
bool is_flat(const Wall& wall, double at_m) {
  constexpr double kRadiator_m = 1.6;
  return std::none_of(wall.reliefs.begin(), wall.reliefs.end(), [&](const Relief& relief) {
    return relief.depth_m > 0 && std::abs(relief.at_m - at_m) < 0.5 * (relief.width_m + kRadiator_m);
  });
}

}  // namespace

void furnish(WorldPlan& plan, const Wall& wall, const Furnishing& furnishing, Random& random) {
  add_columns(plan, wall, furnishing, random);
  for (const Relief& relief : wall.reliefs)
    if (relief.door)
      add_door_frame(plan.steel, wall.frame_at(relief.at_m) * Pose2{0, -relief.depth_m, 0}, relief.width_m,
                     random);

  constexpr double kStretch_m = 2.4;
  for (double at = 0.5 * kStretch_m; at < wall.length_m(); at += kStretch_m)
    if (random.chance(furnishing.radiators) && is_flat(wall, at))
      add_radiator(plan.steel, wall.frame_at(at) * Pose2{0, 0.06, 0}, random.uniform(0.8, 1.6), random);

  if (furnishing.hidden_spacing_m <= 0) return;
  for (double at = furnishing.hidden_spacing_m * random.uniform(); at < wall.length_m();
       at += furnishing.hidden_spacing_m * random.uniform(0.5, 1.5)) {
    const Pose2 behind = wall.frame_at(at) * Pose2{0, -random.uniform(0.15, 1.5), kPi};
    plan.spots.push_back({ThingKind::kHiddenSteel, behind, 0.5, std::nullopt});
  }
}

}  // namespace mstsl::sim
