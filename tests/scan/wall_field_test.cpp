#include "mstsl/scan/wall_field.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "segment_world.hpp"

namespace mstsl {
namespace {

TEST(WallField, HasTheSquaredDistanceAndItsSlope) {
  Random random(1);
  const OccupancyGrid map = test::drawn(test::room(), test::square_around({0.3, -0.2, 0.4}, 6.0));
  const WallField walls(map);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d p(random.uniform(-4, 4), random.uniform(-3, 3));
    const WallField::Sample here = walls.sample(p);
    const double distance_m = walls.distances().at(p);
    EXPECT_NEAR(std::sqrt(here.squared_m2), distance_m, 0.03);
    if (here.squared_m2 >= walls.reach_m() * walls.reach_m()) continue;
    constexpr double kStep_m = 1e-5;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep_m * Eigen::Vector2d::Unit(axis);
      const double slope =
          (walls.sample(p + step).squared_m2 - walls.sample(p - step).squared_m2) / (4 * kStep_m);
      // Bilinear pieces meet in creases.
      EXPECT_NEAR(here.slope_m(axis), slope, 0.06) << p.transpose();
    }
  }
}

TEST(WallField, KnowsWhichWayAWallFaces) {
  for (const double yaw : {0.0, 0.3, 1.0, -2.0}) {
    const Pose2 turned{0, 0, yaw};
    const WallField walls(
        test::drawn(test::moved(turned, {{{-5, 0}, {5, 0}}}), test::square_around({}, 4.0)));
    const Eigen::Vector2d normal = turned.rotation() * Eigen::Vector2d(0, 1);
    for (const double off_m : {-0.2, -0.07, 0.12, 0.3}) {
      const Eigen::Vector3d f = walls.sample(off_m * normal + 0.3 * normal.unitOrthogonal()).facing;
      EXPECT_NEAR(f.x() + f.z(), 1.0, 1e-5);
      const double along_normal = f.x() * normal.x() * normal.x() + 2 * f.y() * normal.x() * normal.y() +
                                  f.z() * normal.y() * normal.y();
      EXPECT_GT(along_normal, 0.93) << yaw << " " << off_m;
    }
  }
}

TEST(WallField, FeelsNothingFarFromWallsOutsideAndAtNoPlace) {
  const WallField walls(test::drawn({{{-1, 0}, {1, 0}}}, test::square_around({}, 5.0)));
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(0, 3), Eigen::Vector2d(100, 0), Eigen::Vector2d(kNaN, 0),
                                   Eigen::Vector2d(1e300, -1e300)}) {
    const WallField::Sample none = walls.sample(p);
    EXPECT_DOUBLE_EQ(none.squared_m2, walls.reach_m() * walls.reach_m());
    EXPECT_TRUE(none.slope_m.isZero());
    EXPECT_TRUE(none.facing.isZero());
  }
}

}  // namespace
}  // namespace mstsl
