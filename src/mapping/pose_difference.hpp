#pragma once

#include <Eigen/Core>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/pose2.hpp"

namespace mstsl {

/// x, y and yaw of `to` less those of `from`, both given in one frame; the yaw the short way round.
inline Eigen::Vector3d difference(const Pose2& from, const Pose2& to) {
  return {to.x - from.x, to.y - from.y, angle_between(from.yaw, to.yaw)};
}

}  // namespace mstsl
