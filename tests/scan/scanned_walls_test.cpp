#include "mstsl/scan/scanned_walls.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/scan/fit_to_walls.hpp"

namespace mstsl {
namespace {

/// The returns of a laser in the middle of a room of 6 x 4 m, one every half degree.
std::vector<BeamReturn> room_from(const Pose2& room_T_base) {
  std::vector<BeamReturn> returns;
  for (int i = 0; i < 720; ++i) {
    const double angle = radians(0.5 * i) + room_T_base.yaw;
    const Eigen::Vector2d d(std::cos(angle), std::sin(angle));
    const double to_x = ((d.x() > 0 ? 3.0 : -3.0) - room_T_base.x) / d.x();
    const double to_y = ((d.y() > 0 ? 2.0 : -2.0) - room_T_base.y) / d.y();
    const Eigen::Vector2d at = room_T_base.position() + std::min(to_x, to_y) * d;
    returns.push_back({{0, 0}, inverse(room_T_base) * at});
  }
  return returns;
}

TEST(FacedPoints, FaceAsTheirWallsDo) {
  for (const FacedPoint& p : faced_points(room_from({}))) {
    EXPECT_NEAR(p.normal.norm(), 1.0, 1e-9);
    const bool in_corner =
        std::abs(std::abs(p.point_m.x()) - 3) < 0.2 && std::abs(std::abs(p.point_m.y()) - 2) < 0.2;
    if (in_corner) continue;
    const bool on_side = std::abs(std::abs(p.point_m.x()) - 3.0) < 1e-9;
    EXPECT_NEAR(std::abs(on_side ? p.normal.x() : p.normal.y()), 1.0, 1e-6) << p.point_m.transpose();
  }
}

TEST(FacedPoints, LeaveOutWhatHasNoNeighbours) {
  const std::vector<BeamReturn> far_apart{
      {{0, 0}, {1, 0}}, {{0, 0}, {0, 5}}, {{0, 0}, {-9, 0}}, {{0, 0}, {0, -3}}};
  EXPECT_TRUE(faced_points(far_apart).empty());
  EXPECT_TRUE(faced_points({}).empty());
}

TEST(ScannedWalls, SampleIsTheDistanceToTheLineOfTheNearestWall) {
  ScannedWalls walls({0, 0});
  walls.add(faced_points(room_from({})), {});
  for (const double off : {-0.3, -0.05, 0.0, 0.1, 0.4}) {
    const WallSample s = walls.sample({3.0 + off, 0.33});
    EXPECT_NEAR(s.squared_m2, off * off, 1e-9) << off;
    EXPECT_NEAR(s.slope_m.x(), off, 1e-6);
    EXPECT_NEAR(s.slope_m.y(), 0.0, 1e-6);
  }
  const WallSample nothing = walls.sample({0, 0});
  EXPECT_EQ(nothing.squared_m2, walls.reach_m() * walls.reach_m());
  EXPECT_EQ(nothing.facing, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(walls.sample({1e9, std::nan("")}).squared_m2, walls.reach_m() * walls.reach_m());
}

TEST(ScannedWalls, AScanIsFittedToWhatAnotherShowed) {
  ScannedWalls walls({0, 0});
  walls.add(faced_points(room_from({0.3, -0.2, 0.1})), {0.3, -0.2, 0.1});
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Pose2 truth{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)};
    const Pose2 guess = truth * Pose2{random.normal(0, 0.05), random.normal(0, 0.05), random.normal(0, 0.02)};
    const PointSet points = thinned(end_points(room_from(truth)), 0.1);
    const WallFit fit = fit_to_walls(walls, points, PosePrior::isotropic(guess, 0.1, 0.05),
                                     {.sigma_m = 0.06, .max_iterations = 15});
    EXPECT_LT(distance(fit.map_T_base, truth), 0.02) << i;
    EXPECT_NEAR(angle_between(fit.map_T_base.yaw, truth.yaw), 0.0, 0.01);
    EXPECT_GT(fit.score, 0.95);
  }
}

TEST(ScannedWalls, ABareWallSaysNothingOfTheWayAlongIt) {
  ScannedWalls walls({0, 0});
  std::vector<FacedPoint> wall;
  for (int i = -40; i <= 40; ++i) wall.push_back({{0.1 * i, 1.0}, {0, 1}});
  walls.add(wall, {});
  const Pose2 guess{0.3, 0.05, 0.0};
  const WallFit fit = fit_to_walls(walls, places_of(wall), PosePrior::isotropic(guess, 0.2, 0.05));
  EXPECT_NEAR(fit.map_T_base.x, 0.3, 0.02);
  EXPECT_NEAR(fit.map_T_base.y, 0.0, 0.005);
  EXPECT_LT(fit.information(0, 0), 1e-3 * fit.information(1, 1));
}

}  // namespace
}  // namespace mstsl
