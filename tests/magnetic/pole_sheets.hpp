#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/magnetic/harmonic_covariance.hpp"

namespace mstsl::test {

/// Poles of random strength and sign on sheets half a metre below or above, or both: a field that the
/// harmonic covariance of depth 1 m stands for, made without it. B_z has standard deviation 1. Over -8 .. 14
/// m.
class PoleSheets {
 public:
  PoleSheets(SourceSide side, Random& random) {
    constexpr int kPoles = 4000;
    constexpr double kLow_m = -12.0, kHigh_m = 18.0, kDistance_m = 0.5;
    for (int i = 0; i < kPoles; ++i) {
      const bool below = side == SourceSide::kBelow || (side == SourceSide::kBoth && i % 2 == 0);
      poles_.push_back({{random.uniform(kLow_m, kHigh_m), random.uniform(kLow_m, kHigh_m)},
                        below ? kDistance_m : -kDistance_m,
                        random.normal()});
    }
    // A sheet of n poles a square metre gives B_z the variance n pi / (2 h^2).
    const double per_m2 = kPoles / std::pow(kHigh_m - kLow_m, 2);
    scale_ = 1.0 / std::sqrt(per_m2 * kPi / 2.0) * kDistance_m;
  }
  Eigen::Array3d at(const Eigen::Vector2d& p) const {
    Eigen::Array3d field = Eigen::Array3d::Zero();
    for (const Pole& pole : poles_) {
      const Eigen::Array3d d(p.x() - pole.position_m.x(), p.y() - pole.position_m.y(), pole.below_m);
      field += pole.strength * d / std::pow(d.square().sum(), 1.5);
    }
    return scale_ * field;
  }

 private:
  struct Pole {
    Eigen::Vector2d position_m;
    double below_m, strength;
  };
  std::vector<Pole> poles_;
  double scale_;
};

}  // namespace mstsl::test
