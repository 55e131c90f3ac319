#include "mstsl/scan/refine.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "segment_world.hpp"

namespace mstsl {
namespace {

PointSet scan_points(const test::Segments& walls, const Pose2& pose, Random& random) {
  const LaserScan scan = test::scan_of(walls, pose, random, {.noise_m = 0.01});
  return at_most(thinned(points_in_base(scan, Eigen::Isometry3d::Identity()), 0.1), 200);
}

Pose2 pose_in_room(Random& random) {
  return {random.uniform(-1.4, 1.4), random.uniform(-1.3, 1.3), random.uniform(-kPi, kPi)};
}

/// A start off the truth by about `sigma_m` and as much at 3 m.
Pose2 near(const Pose2& truth, Random& random, double sigma_m) {
  return truth * Pose2{random.normal(0, sigma_m), random.normal(0, sigma_m), random.normal(0, sigma_m / 3)};
}

Eigen::Vector3d error_of(const Pose2& pose, const Pose2& truth) {
  return {pose.x - truth.x, pose.y - truth.y, angle_between(truth.yaw, pose.yaw)};
}

TEST(RefinePose, FindsThePoseToWithinAFractionOfACell) {
  Random random(1);
  for (const double grid_yaw : {0.0, 0.3, 1.2}) {
    const LikelihoodField field(test::drawn(test::room(), test::square_around({0.013, 0.021, grid_yaw}, 6)));
    for (int trial = 0; trial < 30; ++trial) {
      const Pose2 truth = pose_in_room(random), start = near(truth, random, 0.05);
      const Refinement refined = refine_pose(field, scan_points(test::room(), truth, random), start,
                                             PosePrior::isotropic(start, 0.3, 0.1));
      EXPECT_TRUE(refined.converged);
      EXPECT_LT(distance(refined.map_T_base, truth), 0.025);
      EXPECT_LT(std::abs(angle_between(refined.map_T_base.yaw, truth.yaw)), radians(0.4));
      EXPECT_LT(refined.cost, 0.05);
    }
  }
}

TEST(RefinePose, MovesWithTheWorld) {
  Random random(2);
  GridGeometry geometry = test::square_around({}, 6);
  const OccupancyGrid map = test::drawn(test::room(), geometry);
  for (int trial = 0; trial < 20; ++trial) {
    const Pose2 motion{random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-3, 3)};
    geometry.map_T_grid = motion * map.geometry().map_T_grid;
    const Pose2 truth = pose_in_room(random), start = near(truth, random, 0.03);
    const PointSet points = scan_points(test::room(), truth, random);
    const Refinement here =
        refine_pose(LikelihoodField(map), points, start, PosePrior::isotropic(start, 0.2, 0.1));
    const Refinement there = refine_pose(LikelihoodField(OccupancyGrid(geometry, map.values())), points,
                                         motion * start, PosePrior::isotropic(motion * start, 0.2, 0.1));
    EXPECT_LT(distance(motion * here.map_T_base, there.map_T_base), 2e-3);
    EXPECT_NEAR(angle_between((motion * here.map_T_base).yaw, there.map_T_base.yaw), 0, 1e-3);
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() = motion.rotation();
    const Eigen::Matrix3d expected = turn * here.covariance * turn.transpose();
    EXPECT_LT((expected - there.covariance).norm(), 0.01 * expected.norm());
  }
}

TEST(RefinePose, CoversItsErrorsWithItsCovariance) {
  Random random(3);
  const LikelihoodField field(test::drawn(test::room(), test::square_around({0.013, 0.021, 0.0}, 6)));
  double mean_nees = 0;
  constexpr int kTrials = 100;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Pose2 truth = pose_in_room(random), start = near(truth, random, 0.04);
    const Refinement refined = refine_pose(field, scan_points(test::room(), truth, random), start,
                                           PosePrior::isotropic(start, 0.3, 0.1));
    const Eigen::Vector3d error = error_of(refined.map_T_base, truth);
    mean_nees += error.dot(refined.covariance.inverse() * error) / kTrials;
  }
  EXPECT_LT(mean_nees, 3.0);  // no overconfidence
  EXPECT_GT(mean_nees, 0.05);
}

TEST(RefinePose, KnowsNothingOfTheWayAlongABareCorridor) {
  Random random(4);
  for (const double yaw : {0.0, 0.3, 0.8}) {  // also askew through the cells, where walls are drawn as stairs
    const test::Segments walls = test::moved({0, 0, yaw}, test::bare_corridor());
    const LikelihoodField field(test::drawn(walls, test::square_around({}, 12)));
    const Pose2 truth{0.1, 0.05, yaw}, start = truth * Pose2{0.1, 0.03, 0.02};
    const PointSet points = at_most(
        thinned(points_in_base(test::scan_of(walls, truth, random, {.range_max_m = 10, .noise_m = 0.01}),
                               Eigen::Isometry3d::Identity()),
                0.1),
        200);
    const Refinement refined = refine_pose(field, points, start, PosePrior::isotropic(start, 1.0, 0.3));
    const Eigen::Vector3d along(std::cos(yaw), std::sin(yaw), 0), across(-std::sin(yaw), std::cos(yaw), 0);
    EXPECT_GT(std::sqrt(along.dot(refined.covariance * along)), 0.3) << yaw;
    EXPECT_LT(std::sqrt(across.dot(refined.covariance * across)), 0.06) << yaw;
    EXPECT_LT(std::abs(across.dot(error_of(refined.map_T_base, truth))), 0.03) << yaw;
    EXPECT_NEAR(along.dot(error_of(refined.map_T_base, truth)), 0.1, 0.1)
        << yaw;  // stays where the prior has it
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(refined.information);
    EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-6);
  }
}

TEST(RefinePose, WeighsThePriorAgainstTheScan) {
  Random random(5);
  const LikelihoodField field(test::drawn(test::room(), test::square_around({}, 6)));
  const Pose2 truth{0.5, -0.4, 0.6}, believed = truth * Pose2{0.06, 0.0, 0.0};
  const PointSet points = scan_points(test::room(), truth, random);
  const Refinement firm = refine_pose(field, points, believed, PosePrior::isotropic(believed, 1e-4, 1e-4));
  const Refinement loose = refine_pose(field, points, believed, PosePrior::isotropic(believed, 1.0, 1.0));
  EXPECT_LT(distance(firm.map_T_base, believed), 1e-3);
  EXPECT_LT(distance(loose.map_T_base, truth), 0.035);  // the map's walls are whole cells
  EXPECT_LT(firm.covariance.trace(), loose.covariance.trace());
}

TEST(RefinePose, IsThePriorWithoutEvidence) {
  Random random(6);
  const LikelihoodField field(test::drawn(test::room(), test::square_around({}, 6)));
  const PosePrior prior = PosePrior::isotropic({1, 2, 3}, 0.5, 0.2);
  const Refinement none = refine_pose(field, {}, {1, 1, 1}, prior);
  EXPECT_EQ(distance(none.map_T_base, prior.mean), 0.0);
  EXPECT_TRUE(none.covariance.isApprox(prior.covariance));
  EXPECT_FALSE(none.converged);

  const Refinement far = refine_pose(field, scan_points(test::room(), {}, random), {500, 500, 0},
                                     PosePrior::isotropic({500, 500, 0}, 0.5, 0.2));
  EXPECT_LT(distance(far.map_T_base, {500, 500, 0}), 1e-6);
  EXPECT_TRUE(far.covariance.isApprox(prior.covariance, 1e-6));
  EXPECT_NEAR(far.cost, 1.0, 1e-12);
}

}  // namespace
}  // namespace mstsl
