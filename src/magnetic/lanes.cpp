#include "mstsl/magnetic/lanes.hpp"

#include <cmath>

namespace mstsl {
namespace {

/// Over less than this a direction of travel is mostly noise of the poses.
constexpr double kDirectionBase_m = 0.3;

/// Follows one lane and says when it ends.
class LaneEnd {
 public:
  LaneEnd(const Fingerprint& first, const LaneOptions& options)
      : options_(options), start_(first), corner_(first), previous_(first) {}

  bool before(const Fingerprint& next) const {
    if (next.session != previous_.session || distance(previous_, next) > options_.max_gap_m) return true;
    if (distance(start_, next) > options_.max_length_m) return true;
    const Eigen::Vector2d step = next.position_m - corner_.position_m;
    if (direction_.isZero() || step.norm() < kDirectionBase_m) return false;
    return step.dot(direction_) < std::cos(options_.max_turn_rad) * step.norm();
  }

  void pass(const Fingerprint& next) {
    const Eigen::Vector2d step = next.position_m - corner_.position_m;
    if (step.norm() >= kDirectionBase_m) {
      if (direction_.isZero()) direction_ = step.normalized();
      corner_ = next;
    }
    previous_ = next;
  }

 private:
  static double distance(const Fingerprint& a, const Fingerprint& b) {
    return (a.position_m - b.position_m).norm();
  }

  LaneOptions options_;
  Fingerprint start_, corner_, previous_;
  Eigen::Vector2d direction_ = Eigen::Vector2d::Zero();
};

}  // namespace

std::vector<Lane> split_lanes(std::span<const Fingerprint> fingerprints, const LaneOptions& options) {
  std::vector<Lane> lanes;
  if (fingerprints.empty()) return lanes;
  LaneEnd end(fingerprints[0], options);
  lanes.push_back({0, 1});
  for (std::size_t i = 1; i < fingerprints.size(); ++i) {
    if (end.before(fingerprints[i])) {
      lanes.push_back({i, i});
      end = LaneEnd(fingerprints[i], options);
    } else {
      end.pass(fingerprints[i]);
    }
    lanes.back().last = i + 1;
  }
  return lanes;
}

}  // namespace mstsl
