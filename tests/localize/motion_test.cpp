#include "mstsl/localize/motion.hpp"

#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

TEST(StraightMotion, IsEquationFiveByHand) {
  const Pose2 moved = straight_motion({1.0, 2.0, radians(30)}, 4.0, radians(10));
  EXPECT_NEAR(moved.x, 1.0 + 4.0 * std::sqrt(3.0) / 2, 1e-12);
  EXPECT_NEAR(moved.y, 4.0, 1e-12);
  EXPECT_NEAR(moved.yaw, radians(40), 1e-12);
}

TEST(StraightMotion, IsTheStraightCaseOfComposingPoses) {
  for (const double yaw : {-3.0, -1.0, 0.0, 2.0, 3.1})
    for (const double turn : {-0.5, 0.0, 0.5}) {
      const Pose2 from{-2.0, 5.0, yaw};
      const Pose2 moved = straight_motion(from, 1.7, turn), composed = from * Pose2{1.7, 0.0, turn};
      EXPECT_NEAR(distance(moved, composed), 0.0, 1e-12);
      EXPECT_NEAR(angle_between(moved.yaw, composed.yaw), 0.0, 1e-12);
    }
}

/// The sample covariance of poses moved one by one, against the first-order formula.
TEST(MovedCovariance, AgreesWithMovingManySamples) {
  const Pose2 start{1.0, -2.0, 0.7}, step{1.5, 0.4, 0.3};
  const OdometryNoise noise;
  Eigen::Matrix3d covariance;
  covariance << 0.04, 0.01, 0.002, 0.01, 0.02, -0.001, 0.002, -0.001, 0.001;
  const Eigen::Matrix3d root = covariance.llt().matrixL();
  const Eigen::Matrix3d noise_root = noise.covariance(step).llt().matrixL();
  const Pose2 middle = start * step;
  Random random(5);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  constexpr int kSamples = 200'000;
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector3d off = root * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    const Pose2 from{start.x + off.x(), start.y + off.y(), start.yaw + off.z()};
    const Eigen::Vector3d slip =
        noise_root * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    const Pose2 noisy{step.x + slip.x(), step.y + slip.y(), step.yaw + slip.z()};
    const Pose2 to = from * noisy;
    const Eigen::Vector3d error(to.x - middle.x, to.y - middle.y, angle_between(middle.yaw, to.yaw));
    sum += error * error.transpose();
  }
  const Eigen::Matrix3d predicted = moved_covariance(start, covariance, step, noise);
  EXPECT_LT((sum / kSamples - predicted).norm(), 0.02 * predicted.norm());
}

TEST(MovedCovariance, TurnsTheCovarianceWithNothingElse) {
  const Eigen::Matrix3d covariance = 0.01 * Eigen::Matrix3d::Identity();
  const OdometryNoise perfect{0.0, 0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(moved_covariance({3, 4, 1}, covariance, {}, perfect), covariance);
}

}  // namespace
}  // namespace mstsl
