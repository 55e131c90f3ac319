#include <algorithm>
#include <cmath>

#include "loop_match.hpp"

namespace mstsl {
namespace {

/// What lies within a few decimetres of the best says the same.
bool says_the_same(const LoopMatch& a, const LoopMatch& b) {
  constexpr double kOneAnswer_m = 0.5;
  return distance(a.origin_T_base, b.origin_T_base) < kOneAnswer_m;
}

}  // namespace

LoopChoice choose(const std::vector<LoopMatch>& among, const LoopCloserOptions& options) {
  LoopChoice choice;
  for (std::size_t i = 1; i < among.size(); ++i)
    if (among[i].log_weight(options) > among[choice.best].log_weight(options)) choice.best = i;
  const double most = among[choice.best].log_weight(options);
  double same = 0.0, other = std::exp(std::min(700.0, -most));
  for (const LoopMatch& m : among)
    (says_the_same(m, among[choice.best]) ? same : other) += std::exp(m.log_weight(options) - most);
  choice.probability = same / (same + other);
  return choice;
}

LoopPose pose_of(const std::vector<LoopMatch>& among, std::size_t which, const LoopCloserOptions& options) {
  const LoopMatch& best = among[which];
  Eigen::Vector3d mean(0, 0, 0);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double weights = 0.0;
  for (const LoopMatch& m : among) {
    if (!says_the_same(m, best)) continue;
    const double w = std::exp(m.log_weight(options) - best.log_weight(options));
    const Eigen::Vector3d e = difference(best.origin_T_base, m.origin_T_base);
    mean += w * e, spread += w * e * e.transpose(), weights += w;
  }
  mean /= weights;
  return {Pose2::from(best.origin_T_base.position() + mean.head<2>(), best.origin_T_base.yaw + mean.z()),
          best.covariance + spread / weights - mean * mean.transpose()};
}

}  // namespace mstsl
