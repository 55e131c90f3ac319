#include "mstsl/scan/local_map.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/grid/distance_field.hpp"

#include "segment_world.hpp"

namespace mstsl {
namespace {

const LocalMapOptions kSmall{.half_size_m = 8.0};

/// A way through the room, 5 cm or 3 degrees a step.
std::vector<Pose2> way_through_room() {
  std::vector<Pose2> way{{-1.5, -1.0, 0.0}};
  const auto drive = [&](int steps, double step_m, double turn_deg) {
    for (int i = 0; i < steps; ++i) way.push_back(way.back() * Pose2{step_m, 0, radians(turn_deg)});
  };
  drive(40, 0.05, 0);
  drive(30, 0.03, 3);
  drive(30, 0.05, 0);
  drive(30, 0.03, 3);
  drive(20, 0.05, 0);
  return way;
}

std::vector<BeamReturn> returns_at(const test::Segments& walls, const Pose2& pose, Random& random) {
  return beam_returns(test::scan_of(walls, pose, random, {.beams = 541, .noise_m = 0.01}),
                      Eigen::Isometry3d::Identity());
}

TEST(LocalMap, HoldsItsPoseWhereOdometryDrifts) {
  Random random(1);
  LocalMap map(kSmall);
  const std::vector<Pose2> way = way_through_room();
  Pose2 odometry;
  for (std::size_t i = 0; i < way.size(); ++i) {
    Pose2 step = i == 0 ? Pose2{} : between(way[i - 1], way[i]);
    step = {1.05 * step.x, step.y + 0.003, 1.05 * step.yaw + 0.004};  // 5 % scale error, drift to the left
    if (i > 0) odometry = odometry * step;
    map.insert(returns_at(test::room(), way[i], random), step);
  }
  const Pose2 truth = between(way.front(), way.back());
  EXPECT_GT(distance(odometry, truth), 0.5);
  EXPECT_LT(distance(map.local_T_base(), truth), 0.05);
  EXPECT_LT(std::abs(angle_between(map.local_T_base().yaw, truth.yaw)), radians(1));
}

TEST(LocalMap, DrawsTheWallsWhereTheyAre) {
  Random random(2);
  LocalMap map(kSmall);
  const std::vector<Pose2> way = way_through_room();
  for (std::size_t i = 0; i < way.size(); ++i) {
    map.insert(returns_at(test::room(), way[i], random), i == 0 ? Pose2{} : between(way[i - 1], way[i]));
  }
  const DistanceField walls(
      test::drawn(test::moved(inverse(way.front()), test::room()), test::square_around({}, 10)), 1.0);
  const PointSet points = map.points_in_local();
  EXPECT_GT(points.size(), 150U);
  for (const Eigen::Vector2d& p : points) EXPECT_LT(walls.at(p), 0.15);
  const PointSet seen = transformed(map.local_T_base(), map.points_in_base());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR((seen[i] - points[i]).norm(), 0, 1e-9);
  EXPECT_EQ(state_at(map.occupancy(), {0, 0}), CellState::kFree);
}

TEST(LocalMap, IsTheSameWhereverTheWorldLies) {
  // One local map serves all hypotheses: turned and moved, the same building gives the same map in its own
  // frame.
  const std::vector<Pose2> way = way_through_room();
  LocalMap here(kSmall), there(kSmall);
  const Pose2 motion{40, -25, 2.1};
  for (std::size_t i = 0; i < 40; ++i) {
    const Pose2 step = i == 0 ? Pose2{} : between(way[i - 1], way[i]);
    Random one(i), two(i);
    here.insert(returns_at(test::room(), way[i], one), step);
    there.insert(returns_at(test::moved(motion, test::room()), motion * way[i], two), step);
  }
  EXPECT_LT(distance(here.local_T_base(), there.local_T_base()), 2e-3);
  EXPECT_NEAR(static_cast<double>(here.points_in_local().size()),
              static_cast<double>(there.points_in_local().size()),
              0.02 * static_cast<double>(here.points_in_local().size()));
}

TEST(LocalMap, ForgetsPeopleWhoHaveWalkedOn) {
  Random random(3);
  LocalMap map(kSmall);
  const test::Segments person = test::rectangle(0.5, 0.2, 0.7, 0.4);
  for (int i = 0; i < 12; ++i) {
    const test::Segments walls = i < 2 ? test::joined(test::room(), person) : test::room();
    map.insert(returns_at(walls, {-1.0 + 0.11 * i, 0.0, 0.0}, random), i == 0 ? Pose2{} : Pose2{0.11, 0, 0});
  }
  const auto on_person = [](const Eigen::Vector2d& p) {
    return (p - Eigen::Vector2d(1.6, 0.3)).norm() < 0.2;
  };
  const PointSet points = map.points_in_local();
  EXPECT_TRUE(std::none_of(points.begin(), points.end(), on_person));
}

TEST(LocalMap, FollowsOdometryAlongABareCorridor) {
  Random random(4);
  LocalMap map({.half_size_m = 15.0});
  constexpr int kSteps = 100;
  for (int i = 0; i < kSteps; ++i) {
    const Pose2 pose = Pose2{0, 0, 0.2} * Pose2{0.05 * i, 0.0, 0.0};
    const auto scan = test::scan_of(test::moved({0, 0, 0.2}, test::bare_corridor()), pose, random,
                                    {.beams = 541, .range_max_m = 8, .noise_m = 0.01});
    map.insert(beam_returns(scan, Eigen::Isometry3d::Identity()), i == 0 ? Pose2{} : Pose2{0.05, 0, 0});
  }
  EXPECT_NEAR(map.local_T_base().x, 0.05 * (kSteps - 1), 0.10);
  EXPECT_NEAR(map.local_T_base().y, 0.0, 0.03);
}

TEST(LocalMap, TakesHostileScans) {
  Random random(5);
  LocalMap map(kSmall);
  EXPECT_TRUE(map.empty());
  map.insert({}, {0.1, 0, 0});
  EXPECT_TRUE(map.empty());
  EXPECT_TRUE(map.points_in_base().empty());
  map.insert({{{0, 0}, {1e30, -1e30}}}, {});
  map.insert(returns_at(test::room(), {}, random), {});
  map.insert({}, {0.1, 0, 0});
  map.insert({{{0, 0}, {1e30, -1e30}}, {{0, 0}, {0, 0}}}, {0.1, 0, 0});
  EXPECT_TRUE(map.local_T_base().is_finite());
}

}  // namespace
}  // namespace mstsl
