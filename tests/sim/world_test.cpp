#include "mstsl/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/sim/lidar.hpp"
#include "mstsl/sim/occupancy_map.hpp"
#include "mstsl/sim/robot.hpp"
#include "mstsl/sim/run.hpp"

#include "test_support.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;
using test::must;

class EveryWorld : public ::testing::TestWithParam<std::string> {
 protected:
  World world_ = must(make_world(GetParam(), {}, Random(5)));
};

INSTANTIATE_TEST_SUITE_P(BuiltIn, EveryWorld, ::testing::ValuesIn(world_names()), [](const auto& test) {
  std::string name = test.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

float clearance_at(const World& world, const Vector2d& point) {
  return world.clearance_m()[world.clearance_m().geometry().cell_at(point)];
}

TEST_P(EveryWorld, KeepsItsLanesFree) {
  for (const Lane& lane : world_.lanes())
    for (double t = 0; t <= 1.0; t += 0.01)
      EXPECT_GE(clearance_at(world_, point_along(lane.center, t)), 0.3f);
}

TEST_P(EveryWorld, ConnectsAllLanes) {
  for (const Lane& lane : world_.lanes()) {
    const auto path = plan_path(world_, world_.lanes().front().center.a, lane.center.b);
    ASSERT_TRUE(path) << path.error().message();
    for (std::size_t i = 1; i < path->size(); ++i)
      EXPECT_FALSE(world_.surfaces().blocked((*path)[i - 1], (*path)[i]));
  }
}

TEST_P(EveryWorld, IsTheSameForTheSameSeed) {
  const World again = must(make_world(GetParam(), {}, Random(5))),
              other = must(make_world(GetParam(), {}, Random(6)));
  ASSERT_EQ(again.surfaces().segments().size(), world_.surfaces().segments().size());
  for (std::size_t i = 0; i < again.surfaces().segments().size(); ++i)
    EXPECT_EQ(again.surfaces().segments()[i].a, world_.surfaces().segments()[i].a);
  const Vector2d at = world_.lanes().front().center.a;
  EXPECT_EQ(again.field_uT({at.x(), at.y(), 0.7}), world_.field_uT({at.x(), at.y(), 0.7}));
  EXPECT_NE(other.field_uT({at.x(), at.y(), 0.7}), world_.field_uT({at.x(), at.y(), 0.7}));
}

TEST_P(EveryWorld, MapsWhatItsWallsAre) {
  const OccupancyGrid map = occupancy_map(world_, 0.05);
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Segment& wall = world_.surfaces().segments()[random.index(world_.surfaces().segments().size())];
    EXPECT_EQ(state_at(map, point_along(wall, random.uniform())), CellState::kOccupied);
  }
  for (std::size_t i = 0; i < map.values().size(); i += 7) {
    if (map.values()[i] != CellState::kOccupied) continue;
    EXPECT_LT(world_.surfaces().clearance(map.geometry().center_of(map.geometry().cell(i)), 1.0),
              0.05 * std::sqrt(0.5) + 1e-9);
  }
}

TEST_P(EveryWorld, MapsItsGroundAsFreeAndTheOutsideAsUnknown) {
  const OccupancyGrid map = occupancy_map(world_, 0.05);
  for (const Lane& lane : world_.lanes())
    EXPECT_EQ(state_at(map, point_along(lane.center, 0.37)), CellState::kFree);
  for (std::size_t i = 0; i < map.values().size(); ++i) {
    if (map.values()[i] != CellState::kFree) continue;
    ASSERT_TRUE(world_.plan().footprint_m.contains(map.geometry().center_of(map.geometry().cell(i))));
  }
  EXPECT_EQ(map.values().front(), CellState::kUnknown);
  EXPECT_EQ(map.values().back(), CellState::kUnknown);
}

TEST_P(EveryWorld, IsClosedWhereRobotsDriveOrEndsWithinItsFootprint) {
  for (std::size_t i = 0; i < world_.clearance_m().values().size(); ++i)
    if (world_.clearance_m().values()[i] > 0) {
      ASSERT_TRUE(world_.plan().footprint_m.contains(
          world_.clearance_m().geometry().center_of(world_.clearance_m().geometry().cell(i))));
    }
}

TEST_P(EveryWorld, StaysAsItIsIfNothingMoves) {
  const World later = on_another_day(world_, 0.0, Random(9));
  const Vector2d at = world_.lanes().back().center.b;
  EXPECT_EQ(later.field_uT({at.x(), at.y(), 0.7}), world_.field_uT({at.x(), at.y(), 0.7}));
  EXPECT_EQ(later.surfaces().segments().size(), world_.surfaces().segments().size());
}

TEST_P(EveryWorld, ChangesOnlyItsMovableThingsOverTime) {
  const World later = on_another_day(world_, 0.5, Random(9));
  EXPECT_EQ(later.plan().walls.size(), world_.plan().walls.size());
  EXPECT_EQ(later.plan().steel.size(), world_.plan().steel.size());
  double change = 0.0, count = 0.0;
  for (const Lane& lane : world_.lanes())
    for (double t = 0; t < 1.0; t += 0.05) {
      const Vector2d at = point_along(lane.center, t);
      change +=
          (later.field_uT({at.x(), at.y(), 0.7}) - world_.field_uT({at.x(), at.y(), 0.7})).squaredNorm() /
          3.0;
      count += 1.0;
    }
  const double rms_uT = std::sqrt(change / count);
  EXPECT_GT(rms_uT, 0.02);
  EXPECT_LT(rms_uT, 5.0) << "furniture must not outweigh the building";
}

TEST(World, HasCarsThatComeAndGo) {
  const World morning = must(make_world("carpark", {}, Random(1)));
  const World evening = on_another_day(morning, 0.4, Random(2));
  int changed = 0, cars = 0;
  for (std::size_t i = 0; i < morning.plan().spots.size(); ++i) {
    if (morning.plan().spots[i].kind != ThingKind::kCar) continue;
    ++cars;
    changed += morning.plan().spots[i].thing.has_value() != evening.plan().spots[i].thing.has_value();
  }
  EXPECT_GT(cars, 60);
  EXPECT_GT(changed, cars / 20);
  EXPECT_LT(changed, cars / 2);
}

TEST(World, SaysWhichWorldsThereAre) {
  const auto none = make_world("airport", {}, Random(1));
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message().find("corridor, carpark, warehouse, office-wing"), std::string::npos);
}

TEST(World, RefusesSizesItCannotBuildIn) {
  for (const Vector2d& size :
       {Vector2d(3, 3), Vector2d(1e6, 20), Vector2d(60, std::numeric_limits<double>::infinity())}) {
    WorldOptions options;
    options.size_m = size;
    for (const std::string& name : world_names())
      EXPECT_FALSE(make_world(name, options, Random(1))) << name << size.transpose();
  }
}

TEST(World, IsBuiltInOtherSizes) {
  for (const std::string& name : world_names()) {
    WorldOptions options;
    options.size_m = {40, 26};
    const World world = must(make_world(name, options, Random(1)));
    EXPECT_TRUE(random_run(world, {}, Random(1))) << name;
  }
}

TEST(World, HasStrongerSteelWhenAskedTo) {
  WorldOptions none;
  none.magnetisation = 0.0;
  const auto spread = [](const World& world) {
    double sum = 0.0;
    for (double t = 0; t < 1; t += 0.01) {
      const Vector2d at = point_along(world.lanes().front().center, t);
      sum += (world.field_uT({at.x(), at.y(), 0.7}) - world.field().earth().in_map_uT()).squaredNorm();
    }
    return sum;
  };
  EXPECT_LT(4.0 * spread(must(make_world("corridor", none, Random(1)))),
            spread(must(make_world("corridor", {}, Random(1)))));
}

/// The corridor's point: seen by lidar, opposite poses are the same; felt by a magnetometer, they are not.
TEST(Corridor, LooksAlikeFromOppositePosesButFeelsDifferent) {
  const World world = must(make_world("corridor", {}, Random(4)));
  LidarOptions exact;
  exact.near_noise_m = exact.far_noise_m = exact.dropout = 0.0;
  exact.detection_range_m = 1e6;
  double alike = 0.0, beams = 0.0, field_change = 0.0;
  constexpr int kPoses = 25;
  for (int i = 0; i < kPoses; ++i) {
    const Vector2d at = must(random_waypoint(world, {}, Random(100 + i)));
    const Pose2 here = Pose2::from(at, 0.1 * i), there = Pose2{0, 0, kPi} * here;
    const auto scan_at = [&](const Pose2& pose) {
      Random random(1);
      return scan(world, {}, {{}, 0.01, {pose}}, 0.0, default_rig().base_T_laser, exact, random);
    };
    const LaserScan a = scan_at(here), b = scan_at(there);
    for (std::size_t k = 0; k < a.ranges_m.size(); ++k, beams += 1.0)
      alike += std::abs(a.ranges_m[k] - b.ranges_m[k]) < 0.1 ||
               (std::isinf(a.ranges_m[k]) && std::isinf(b.ranges_m[k]));
    const auto felt = [&](const Pose2& pose) {
      return Eigen::Vector3d(to_isometry3(pose).linear().transpose() * world.field_uT({pose.x, pose.y, 0.7}));
    };
    field_change += (felt(here) - felt(there)).norm() / kPoses;
  }
  EXPECT_GT(alike / beams, 0.9);
  EXPECT_LT(alike / beams, 1.0) << "no building is exactly symmetric";
  EXPECT_GT(field_change, 5.0);
}

}  // namespace
}  // namespace mstsl::sim
