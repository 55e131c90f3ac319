#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/pose2.hpp"

namespace mstsl {

/// A set of poses no two of which are near each other, found by place: cells of the nearness in a hash table.
class NearPoses {
 public:
  NearPoses(double near_m, double near_rad) : near_m_(near_m), near_rad_(near_rad) {}

  /// Adds a pose unless one that was added before is near. Whether it was added.
  bool add_if_far(const Pose2& pose) {
    const auto x = static_cast<std::int64_t>(std::floor(pose.x / near_m_));
    const auto y = static_cast<std::int64_t>(std::floor(pose.y / near_m_));
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const auto found = cells_.find(key(x + dx, y + dy));
        if (found == cells_.end()) continue;
        for (const Pose2& other : found->second)
          if (distance(other, pose) < near_m_ && std::abs(angle_between(other.yaw, pose.yaw)) < near_rad_)
            return false;
      }
    }
    cells_[key(x, y)].push_back(pose);
    return true;
  }

 private:
  static std::uint64_t key(std::int64_t x, std::int64_t y) {
    return (static_cast<std::uint64_t>(x) << 32) ^ (static_cast<std::uint64_t>(y) & 0xFFFFFFFFu);
  }

  double near_m_;
  double near_rad_;
  std::unordered_map<std::uint64_t, std::vector<Pose2>> cells_;
};

}  // namespace mstsl
