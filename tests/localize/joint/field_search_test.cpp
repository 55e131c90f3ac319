#include "mstsl/localize/joint/field_search.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

#include "../hand_made_world.hpp"

namespace mstsl::joint {
namespace {

const Eigen::Vector2d kMagnetometer_m(0.1, -0.05);

/// What a robot reads on the last 3 m of a straight way that ends at a pose.
std::vector<Station> way_to(const test::HandMadeWorld& world, const Pose2& end,
                            const Eigen::Vector3d& bias_uT) {
  std::vector<Station> way;
  for (double behind_m = 3.0; behind_m > -1e-9; behind_m -= 0.15) {
    Station station;
    station.base_T_then = Pose2{-behind_m, 0, 0};
    const Pose2 then = end * station.base_T_then;
    const Eigen::Vector3d map_uT = world.field_uT(then * kMagnetometer_m);
    station.base_field_uT = Eigen::AngleAxisd(-then.yaw, Eigen::Vector3d::UnitZ()) * map_uT + bias_uT;
    way.push_back(station);
  }
  return way;
}

struct FieldSearchTest : testing::Test {
  test::HandMadeWorld world;
  FieldSearch search{world.map};
  std::vector<Pose2> find(const std::vector<Station>& way, Threads threads = {1}) const {
    return search.find(way, world.maps->field_cells, kMagnetometer_m, {}, threads);
  }
};

TEST_F(FieldSearchTest, HasTheTruthAmongItsPosesWhateverTheBias) {
  Random random(61);
  for (int i = 0; i < 12; ++i) {
    const Pose2 truth = i % 2 == 0 ? Pose2{random.uniform(4.5, 20), random.uniform(0.6, 1.4), 0.0}
                                   : Pose2{random.uniform(4, 19.5), random.uniform(8.6, 9.4), kPi};
    const Eigen::Vector3d bias_uT(random.uniform(-7, 7), random.uniform(-7, 7), random.uniform(-7, 7));
    const auto poses = find(way_to(world, truth, bias_uT));
    bool among = false;
    for (const Pose2& pose : poses)
      among = among ||
              (distance(pose, truth) < 0.36 && std::abs(angle_between(pose.yaw, truth.yaw)) < radians(11));
    EXPECT_TRUE(among) << truth.x << " " << truth.y << " of " << poses.size();
    EXPECT_LE(poses.size(), FieldSearchOptions{}.max_poses);
  }
}

TEST_F(FieldSearchTest, IsTheSameAtAnyNumberOfThreads) {
  const auto way = way_to(world, {10, 1, 0}, {3, -2, 1});
  const auto one = find(way), three = find(way, {3});
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(distance(one[i], three[i]), 0.0);
}

TEST_F(FieldSearchTest, AFieldThatSaysNothingAllowsEveryPlace) {
  // One reading that no place has: all are equally bad, and none is left out for it.
  std::vector<Station> way(1);
  way[0].base_field_uT = {0, 0, 500};
  EXPECT_EQ(find(way).size(), FieldSearchOptions{}.max_poses);
}

}  // namespace
}  // namespace mstsl::joint
