#include "mstsl/localize/motion_noise.hpp"

#include <cmath>

namespace mstsl {
namespace {

double square(double x) { return x * x; }

}  // namespace

Eigen::Matrix3d MotionNoise::covariance(const Pose2& motion) const {
  const double way_m = std::hypot(motion.x, motion.y), turn_rad = std::abs(motion.yaw);
  const double place_m2 = square(m_per_root_m) * way_m + square(floor_m);
  const double yaw_rad2 =
      square(rad_per_root_m) * way_m + square(rad_per_root_rad) * turn_rad + square(floor_rad);
  return Eigen::Vector3d(place_m2, place_m2, yaw_rad2).asDiagonal();
}

}  // namespace mstsl
