#include "mstsl/scan/fit_to_walls.hpp"

#include <gtest/gtest.h>

#include "segment_world.hpp"

namespace mstsl {
namespace {

PointSet seen_from(const test::Segments& world, const Pose2& pose, double noise_m, Random& random) {
  test::LidarModel lidar;
  lidar.noise_m = noise_m;
  return at_most(
      thinned(points_in_base(test::scan_of(world, pose, random, lidar), Eigen::Isometry3d::Identity()), 0.2),
      80);
}

TEST(FitToWalls, FindsThePoseFromWithinItsReach) {
  Random random(2);
  const WallField walls(test::drawn(test::room(), test::square_around({0.1, 0.2, 0.7}, 6.0)));
  for (int i = 0; i < 60; ++i) {
    const Pose2 truth =
        Pose2::from({random.uniform(-1.5, 1.5), random.uniform(-1, 1)}, random.uniform(-kPi, kPi));
    const PointSet points = seen_from(test::room(), truth, 0.01, random);
    const Pose2 guess =
        truth * Pose2{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.05)};
    const WallFit fit = fit_to_walls(walls, points, PosePrior::isotropic(guess, 0.15, 0.06));
    EXPECT_LT(distance(fit.map_T_base, truth), 0.03);
    EXPECT_LT(std::abs(angle_between(fit.map_T_base.yaw, truth.yaw)), radians(0.7));
    EXPECT_GT(fit.score, 0.9);
  }
}

TEST(FitToWalls, LeavesTheWayAlongABareCorridorOpen) {
  Random random(3);
  const WallField walls(test::drawn(test::bare_corridor(), test::square_around({}, 40.0)));
  const Pose2 truth{0.3, 0.2, 0.1};
  const PointSet points = seen_from(test::bare_corridor(), truth, 0.0, random);
  const Pose2 guess{0.55, 0.15, 0.12};
  const WallFit fit = fit_to_walls(walls, points, PosePrior::isotropic(guess, 0.3, 0.05));
  EXPECT_NEAR(fit.map_T_base.y, truth.y, 0.03);
  EXPECT_NEAR(fit.map_T_base.x, guess.x, 0.05);  // nothing pulls it along the walls
  EXPECT_LT(fit.information(0, 0), 0.05 * fit.information(1, 1));
}

TEST(FitToWalls, KeepsThePriorWithoutPoints) {
  const WallField walls(test::drawn(test::room(), test::square_around({}, 6.0)));
  const WallFit fit = fit_to_walls(walls, {}, PosePrior::isotropic({1, 2, 3}, 0.1, 0.1));
  EXPECT_DOUBLE_EQ(fit.map_T_base.x, 1.0);
  EXPECT_DOUBLE_EQ(fit.score, 0.0);
  EXPECT_TRUE(fit.information.isZero());
}

TEST(FitToWalls, StaysNearItsPriorWhateverThePointsAre) {
  Random random(4);
  const WallField walls(test::drawn(test::room(), test::square_around({}, 6.0)));
  for (int i = 0; i < 200; ++i) {
    PointSet nonsense;
    for (int k = 0; k < 60; ++k) nonsense.emplace_back(random.uniform(-30, 30), random.uniform(-30, 30));
    const Pose2 from = Pose2::from({random.uniform(-6, 6), random.uniform(-6, 6)}, random.uniform(-kPi, kPi));
    const WallFit fit = fit_to_walls(walls, nonsense, PosePrior::isotropic(from, 10.0, 1.0));
    ASSERT_TRUE(fit.map_T_base.is_finite());
    EXPECT_TRUE(fit.information.allFinite());
    EXPECT_LE(distance(fit.map_T_base, from), 1.1);  // five steps of 0.2 m
  }
}

TEST(MappedScore, IsTheWallScoreWhereAllIsKnown) {
  Random random(6);
  const OccupancyGrid map = test::drawn(test::room(), test::square_around({}, 6.0));
  const WallField walls(map);
  for (int i = 0; i < 50; ++i) {
    const Pose2 pose =
        Pose2::from({random.uniform(-1.5, 1.5), random.uniform(-1, 1)}, random.uniform(-kPi, kPi));
    const PointSet points = seen_from(test::room(), pose, 0.02, random);
    EXPECT_NEAR(mapped_score(map, walls, points, pose, 0.1, 0.5), wall_score(walls, points, pose, 0.1), 0.02);
  }
}

TEST(MappedScore, HoldsAWallThatWasNeverMappedAgainstNobody) {
  Random random(7);
  OccupancyGrid map = test::drawn(test::room(), test::square_around({}, 6.0));
  const WallField whole(map);
  const Pose2 truth{0.2, 0.1, 0.4};
  const PointSet points = seen_from(test::room(), truth, 0.01, random);
  // The survey did not see what lies left of x = -2: wall and all.
  for (std::size_t i = 0; i < map.values().size(); ++i)
    if (map.geometry().center_of(map.geometry().cell(i)).x() < -2.0) map.values()[i] = CellState::kUnknown;
  const WallField known(map);
  const double plain = wall_score(known, points, truth, 0.1);
  EXPECT_LT(plain, wall_score(whole, points, truth, 0.1) - 0.1);
  const double mapped = mapped_score(map, known, points, truth, 0.1, 0.5);
  EXPECT_GT(mapped, plain + 0.05);
  EXPECT_EQ(mapped_score(map, known, points, truth, 0.1, 0.0), plain);
}

TEST(MappedScore, OfAPoseBeyondAllThatIsKnownIsTheUnmappedOne) {
  Random random(8);
  const OccupancyGrid map = test::drawn(test::room(), test::square_around({}, 6.0));
  const PointSet points = seen_from(test::room(), {}, 0.01, random);
  EXPECT_DOUBLE_EQ(mapped_score(map, WallField(map), points, {500, 0, 0}, 0.1, 0.56), 0.56);
  EXPECT_EQ(mapped_score(map, WallField(map), {}, {}, 0.1, 0.56), 0.0);
}

}  // namespace
}  // namespace mstsl
