#include "mstsl/scan/match_submap.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "mstsl/grid/crop.hpp"

#include "segment_world.hpp"

namespace mstsl {
namespace {

/// A long corridor with a few niches: alike everywhere, yet not the same.
test::Segments corridor_with_niches() {
  test::Segments walls = test::rectangle(-20, -1.1, 20, 1.1);
  for (const double x : {-15.0, -9.0, -4.0, 2.5, 6.0, 13.0})
    walls = test::joined(walls, test::rectangle(x, 0.9, x + 0.9, 1.1));
  return walls;
}

PointSet scan_points(const Pose2& pose, Random& random) {
  return points_in_base(test::scan_of(corridor_with_niches(), pose, random, {.noise_m = 0.01}),
                        Eigen::Isometry3d::Identity());
}

TEST(MatchSubmap, FindsATrueHypothesisWithin3Sigma) {
  Random random(1);
  const MatchMap map(test::drawn(corridor_with_niches(), test::square_around({}, 22)));
  for (int trial = 0; trial < 15; ++trial) {
    const Pose2 truth{random.uniform(-12, 12), random.uniform(-0.4, 0.4), random.uniform(-3, 3)};
    const PointSet points = scan_points(truth, random);
    const PosePrior prior = PosePrior::isotropic(
        truth * Pose2{random.normal(0, 0.4), random.normal(0, 0.4), random.normal(0, 0.05)}, 0.5, 0.06);
    const auto match = match_submap(map, thinned(points, 0.1), points, prior);
    ASSERT_TRUE(match);
    EXPECT_LT(distance(match->refined.map_T_base, truth), 0.05);
    EXPECT_LT(std::abs(angle_between(match->refined.map_T_base.yaw, truth.yaw)), radians(0.5));
    EXPECT_GT(match->confidence, 0.95);
    EXPECT_GT(match->search_score, 0.85);
    EXPECT_TRUE(match->refined.converged);
  }
}

TEST(MatchSubmap, GivesAFalseHypothesisALowScoreOrNone) {
  Random random(2);
  const MatchMap map(test::drawn(corridor_with_niches(), test::square_around({}, 22)));
  const PointSet points = scan_points({0, 0, 0}, random);
  const auto across =
      match_submap(map, thinned(points, 0.1), points, PosePrior::isotropic({0, 0, radians(90)}, 0.5, 0.06));
  EXPECT_TRUE(!across || across->confidence < kConfidenceThreshold);
  EXPECT_FALSE(match_submap(map, thinned(points, 0.1), points, PosePrior::isotropic({500, 0, 0}, 0.5, 0.06)));
  EXPECT_FALSE(match_submap(map, {}, {}, PosePrior::isotropic({0, 0, 0}, 0.5, 0.06)));
}

TEST(MatchSubmap, NeedsNoMoreThanTheSubmapOfTheLocalMapsSize) {
  // The paper matches M_L,k to a submap M_G,s of the same size. Points of the local map reach no farther than
  // that, so the whole map and the submap give the same answer, and none has to be cut out for each
  // hypothesis.
  Random random(3);
  const OccupancyGrid whole = test::drawn(corridor_with_niches(), test::square_around({}, 22));
  const Pose2 truth{3.0, 0.2, 0.4};
  PointSet points;
  for (const Eigen::Vector2d& p : scan_points(truth, random)) {
    if (p.norm() < 6) points.push_back(p);
  }
  const PosePrior prior = PosePrior::isotropic(truth * Pose2{0.2, 0.1, 0.03}, 0.2, 0.03);
  const auto in_whole = match_submap(MatchMap(whole), thinned(points, 0.1), points, prior);
  const auto in_submap =
      match_submap(MatchMap(crop(whole, prior.mean.position(), 8.0)), thinned(points, 0.1), points, prior);
  ASSERT_TRUE(in_whole && in_submap);
  EXPECT_NEAR(distance(in_whole->refined.map_T_base, in_submap->refined.map_T_base), 0, 1e-6);
  EXPECT_EQ(in_whole->confidence, in_submap->confidence);
}

}  // namespace
}  // namespace mstsl
