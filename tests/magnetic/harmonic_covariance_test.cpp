#include "mstsl/magnetic/harmonic_covariance.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

#include "harmonic/dense.hpp"

namespace mstsl {
namespace {

constexpr double kDepth_m = 1.3;

/// Potential of the covariance's sheet at two points, and heights above the plane added to the depth.
double potential(const Eigen::Vector2d& d, double heights_m) {
  return std::pow(kDepth_m, 3) / 2 / std::hypot(d.x(), d.y(), kDepth_m + heights_m);
}

/// Every entry is a second derivative of the potential's covariance: minus the gradient at both points.
TEST(HarmonicCovariance, IsThatOfAPotentialsGradient) {
  const double e = 1e-3;
  for (const Eigen::Vector2d& d :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.4, -0.9), Eigen::Vector2d(2, 1)}) {
    const Eigen::Matrix3d k = harmonic_covariance(SourceSide::kBelow, kDepth_m, d);
    const auto second = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      const auto at = [&](double s, double t) {
        const Eigen::Vector3d first = s * e * a, other = t * e * b;
        return potential(d + first.head<2>() - other.head<2>(), first.z() + other.z());
      };
      return (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * e * e);
    };
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(k(i, j), second(Eigen::Vector3d::Unit(i), Eigen::Vector3d::Unit(j)), 1e-5) << i << j;
  }
}

TEST(HarmonicCovariance, BelowAndAboveDifferInTheSignOfBz) {
  const Eigen::Vector2d d(0.7, 0.2);
  const Eigen::Matrix3d below = harmonic_covariance(SourceSide::kBelow, kDepth_m, d),
                        above = harmonic_covariance(SourceSide::kAbove, kDepth_m, d),
                        both = harmonic_covariance(SourceSide::kBoth, kDepth_m, d);
  const Eigen::DiagonalMatrix<double, 3> mirror(1.0, 1.0, -1.0);
  EXPECT_TRUE(above.isApprox(mirror * below * mirror));
  EXPECT_TRUE(both.isApprox(0.5 * (below + above)));
}

TEST(HarmonicCovariance, IsPositiveDefiniteAtAnyPoints) {
  Random random(5);
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < 60; ++i) points_m.emplace_back(random.uniform(0, 8), random.uniform(0, 8));
  for (const SourceSide side : {SourceSide::kBelow, SourceSide::kAbove, SourceSide::kBoth}) {
    HarmonicHyperparameters h;
    h.side = side;
    h.depth_m = kDepth_m;
    h.signal_sd_uT = 1.0;
    const Eigen::MatrixXd k = harmonic_covariance(h, points_m, points_m);
    EXPECT_TRUE(k.isApprox(k.transpose()));
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues().minCoeff(), -1e-10);
  }
}

TEST(HarmonicCovariance, ResemblesAnIndependentOneAtItsLength) {
  HarmonicHyperparameters h;
  h.depth_m = kDepth_m;
  const FieldHyperparameters like = as_independent(h);
  const Eigen::Vector2d away(like.length_scale_m(0), 0.0);
  EXPECT_NEAR(harmonic_covariance(h.side, h.depth_m, away)(2, 2), std::exp(-0.5), 0.01);
  EXPECT_NEAR(like.signal_sd_uT(2), h.signal_sd_uT, 1e-12);
  EXPECT_NEAR(like.signal_sd_uT(0), h.signal_sd_uT / std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace mstsl
