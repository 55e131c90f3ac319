#include "mstsl/localize/orientation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/Geometry>

#include "mstsl/core/angles.hpp"

namespace mstsl {

AxisAngle turn_between(const Eigen::Vector3d& d_axis, const Eigen::Vector3d& g_axis) {
  const double lengths = d_axis.norm() * g_axis.norm();
  assert(lengths > 0.0);
  const Eigen::Vector3d cross = d_axis.cross(g_axis);
  const bool parallel = cross.norm() <= 1e-12 * lengths;
  return {std::acos(std::clamp(d_axis.dot(g_axis) / lengths, -1.0, 1.0)),
          parallel ? Eigen::Vector3d::Zero() : Eigen::Vector3d(cross.normalized())};
}

double orientation(const AxisAngle& d_to_g) {
  if (d_to_g.phi_rad < kPi / 4) return 0.0;
  if (d_to_g.phi_rad > 3 * kPi / 4) return -kPi;
  return d_to_g.axis.z() > 0.0 ? -kPi / 2 : kPi / 2;
}

}  // namespace mstsl
