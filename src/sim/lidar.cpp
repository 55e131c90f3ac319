#include "mstsl/sim/lidar.hpp"

#include <cmath>
#include <limits>
#include <optional>

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;

constexpr double kFarFrom_m = 10.0;      // where the data sheet changes to the larger noise
constexpr double kResolution_m = 0.001;  // ranges come in whole millimetres
constexpr double kWhiteSheet = 0.9;      // reflectivity that the data sheet's ranges are given for

/// The nearest leg along a ray, as range and cosine of incidence.
std::optional<RayHit> cast(const std::vector<Leg>& legs, const Vector2d& origin_m,
                           const Vector2d& direction) {
  std::optional<RayHit> nearest;
  for (const Leg& leg : legs) {
    const Vector2d to_leg = leg.center_m - origin_m;
    const double along = to_leg.dot(direction);
    const double across2 = to_leg.squaredNorm() - along * along, radius2 = leg.radius_m * leg.radius_m;
    if (along <= 0 || across2 >= radius2) continue;
    const double depth = std::sqrt(radius2 - across2);
    if (along > depth && (!nearest || along - depth < nearest->range_m))
      nearest = RayHit{along - depth, depth / leg.radius_m, 0};
  }
  return nearest;
}

/// Probability that the echo is strong enough: received power goes with cos(incidence) / range^2 (diffuse
/// wall).
double detection_probability(const RayHit& hit, const LidarOptions& options) {
  const double reach = options.detection_range_m / hit.range_m;
  const double power = options.reflectivity / kWhiteSheet * hit.cos_incidence * reach * reach;
  const double steep = power * power * power * power;  // the threshold is sharp: receivers' noise is small
  return std::isfinite(steep) ? steep / (1.0 + steep) : 1.0;
}

float measured(const std::optional<RayHit>& hit, const LidarOptions& options, Random& random) {
  constexpr float kNothing = std::numeric_limits<float>::infinity();
  if (!hit || random.chance(options.dropout) || !random.chance(detection_probability(*hit, options)))
    return kNothing;
  const double noisy =
      hit->range_m +
      (hit->range_m < kFarFrom_m ? options.near_noise_m : options.far_noise_m) * random.normal();
  const double rounded = kResolution_m * std::round(noisy / kResolution_m);
  return rounded >= options.range_min_m && rounded <= options.range_max_m ? static_cast<float>(rounded)
                                                                          : kNothing;
}

}  // namespace

LaserScan scan(const World& world, const People& people, const Trajectory& trajectory, double seconds,
               const Eigen::Isometry3d& base_T_laser, const LidarOptions& options, Random& random) {
  LaserScan scan;
  scan.stamp = trajectory.start + seconds;
  scan.angle_min_rad = -0.5 * options.field_of_view_rad;
  scan.angle_increment_rad = options.beams > 1 ? options.field_of_view_rad / (options.beams - 1) : 0.0;
  scan.time_increment_s = options.beams > 1 ? options.sweep_s / (options.beams - 1) : 0.0;
  scan.range_min_m = options.range_min_m;
  scan.range_max_m = options.range_max_m;
  scan.ranges_m.reserve(static_cast<std::size_t>(std::max(0, options.beams)));

  const Eigen::Matrix2d mounting = base_T_laser.linear().topLeftCorner<2, 2>();  // also right upside down
  const Vector2d lever_m = base_T_laser.translation().head<2>();
  const Pose2 middle = trajectory.at(seconds + 0.5 * options.sweep_s);
  const std::vector<Leg> legs = people.legs(seconds, middle.position(), options.range_max_m);
  for (int beam = 0; beam < options.beams; ++beam) {
    const Pose2 base = trajectory.at(seconds + beam * scan.time_increment_s);
    const double angle = scan.angle_min_rad + beam * scan.angle_increment_rad;
    const Eigen::Matrix2d turn = base.rotation();
    const Vector2d origin = base.position() + turn * lever_m;
    const Vector2d direction = (turn * mounting * Vector2d(std::cos(angle), std::sin(angle))).normalized();
    std::optional<RayHit> hit = world.surfaces().cast(origin, direction, options.range_max_m);
    if (const auto leg = cast(legs, origin, direction); leg && (!hit || leg->range_m < hit->range_m))
      hit = leg;
    scan.ranges_m.push_back(measured(hit, options, random));
  }
  return scan;
}

}  // namespace mstsl::sim
