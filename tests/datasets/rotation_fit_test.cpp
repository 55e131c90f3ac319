#include "mstsl/datasets/rotation_fit.hpp"

#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

#include "test_support.hpp"

namespace mstsl::datasets {
namespace {

using Vectors = std::vector<Eigen::Vector3d>;

Eigen::Vector3d random_vector(Random& random, double size) {
  return {random.normal(0.0, size), random.normal(0.0, size), random.normal(0.0, size)};
}

Eigen::Matrix3d random_rotation(Random& random) {
  return Eigen::AngleAxisd(random.uniform(0.0, 3.1), random_vector(random, 1.0).normalized())
      .toRotationMatrix();
}

Vectors rotated(const Eigen::Matrix3d& rotation, const Vectors& vectors) {
  Vectors result;
  for (const Eigen::Vector3d& v : vectors) result.emplace_back(rotation * v);
  return result;
}

TEST(RotationFit, FindsAKnownRotation) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Matrix3d truth = random_rotation(random);
    Vectors from;
    for (int i = 0; i < 5; ++i) from.push_back(random_vector(random, 30.0));
    const RotationFit fit = test::must(fit_rotation(from, rotated(truth, from)));
    EXPECT_LT((fit.to_R_from - truth).norm(), 1e-12);
    EXPECT_LT(fit.residual_rms.norm(), 1e-12);
  }
}

TEST(RotationFit, IsARotationEvenWhereAReflectionFitsBetter) {
  Random random(2);
  Vectors from, mirrored;
  for (int i = 0; i < 20; ++i) {
    from.push_back(random_vector(random, 10.0));
    mirrored.emplace_back(from.back().x(), from.back().y(), -from.back().z());
  }
  const RotationFit fit = test::must(fit_rotation(from, mirrored));
  EXPECT_NEAR(fit.to_R_from.determinant(), 1.0, 1e-12);
  EXPECT_LT((fit.to_R_from * fit.to_R_from.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(RotationFit, IsBetterThanAnyNeighbour) {
  Random random(3);
  const Eigen::Matrix3d truth = random_rotation(random);
  Vectors from, to;
  for (int i = 0; i < 40; ++i) {
    from.push_back(random_vector(random, 20.0));
    to.push_back(truth * from.back() + random_vector(random, 4.0));
  }
  const RotationFit fit = test::must(fit_rotation(from, to));
  const double best = fit.residual_rms.squaredNorm();
  for (int axis = 0; axis < 3; ++axis)
    for (const double angle : {-0.01, 0.01}) {
      const Eigen::Matrix3d nudged =
          Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)).toRotationMatrix() * fit.to_R_from;
      EXPECT_GT(residual_rms(nudged, from, to).squaredNorm(), best);
    }
}

TEST(RotationFit, RefusesVectorsAlongOneLine) {
  const Vectors along = {{1.0, 2.0, 3.0}, {2.0, 4.0, 6.0}, {-1.0, -2.0, -3.0}};
  EXPECT_FALSE(fit_rotation(along, along).ok());
  EXPECT_FALSE(fit_rotation(Vectors{}, Vectors{}).ok());
  const Vectors nothing = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  EXPECT_FALSE(fit_rotation(nothing, nothing).ok());
}

}  // namespace
}  // namespace mstsl::datasets
