#include "hard_crowd.hpp"

#include <cmath>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

constexpr double kRadius_m = 0.15;  // two legs, trousers, a bag
constexpr double kNoise_m = 0.01;   // as the lidar's

}  // namespace

Crowd::Crowd(double share_of_beams, const LaserScan& like, const Random& random) : random_(random) {
  const double view_rad = like.angle_increment_rad * static_cast<double>(like.ranges_m.size());
  for (double hidden_rad = 0.0; hidden_rad < share_of_beams * view_rad;) {
    const double range_m = random_.uniform(0.7, 2.5);
    hidden_rad += 2.0 * std::asin(kRadius_m / range_m);
    const double angle = like.angle_min_rad + random_.uniform() * view_rad;
    const double sway = random_.uniform(0.1, 0.5), period_s = random_.uniform(3.0, 12.0);
    walkers_.push_back({angle, range_m, sway, period_s, random_.uniform(-kPi, kPi)});
  }
}

void Crowd::hide(LaserScan& scan, double seconds) {
  for (const Walker& walker : walkers_) {
    const double swing = std::sin(2 * kPi * seconds / walker.sway_s + walker.phase_rad);
    const double at = walker.angle_rad + walker.sway_rad * swing,
                 range_m = walker.range_m * (1 + 0.2 * swing);
    for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
      const double off = scan.angle_min_rad + static_cast<double>(beam) * scan.angle_increment_rad - at;
      const double aside_m = range_m * std::sin(off);
      if (std::cos(off) <= 0 || std::abs(aside_m) >= kRadius_m) continue;
      const double hit_m = range_m * std::cos(off) - std::sqrt(kRadius_m * kRadius_m - aside_m * aside_m) +
                           kNoise_m * random_.normal();
      if (!(scan.ranges_m[beam] < hit_m)) scan.ranges_m[beam] = static_cast<float>(hit_m);
    }
  }
}

}  // namespace mstsl
