#include "mstsl/scan/place_search.hpp"

#include <gtest/gtest.h>

#include "segment_world.hpp"

namespace mstsl {
namespace {

PointSet seen_from(const test::Segments& world, const Pose2& pose, Random& random) {
  return points_in_base(test::scan_of(world, pose, random), Eigen::Isometry3d::Identity());
}

TEST(ScoreBounds, HoldForEveryPoseOfABlock) {
  Random random(5);
  const WallField walls(test::drawn(test::room(), test::square_around({0.2, 0.1, 0.5}, 6.0)));
  const ScoreBounds bounds(walls, 0.1, 12.0);
  const PointSet points = at_most(thinned(seen_from(test::room(), {0.5, -0.5, 0.3}, random), 0.3), 60);
  for (int i = 0; i < 3000; ++i) {
    const double side_m = std::vector{0.1, 0.2, 0.4}[random.index(3)], turn = radians(7.5 * side_m);
    const Pose2 middle =
        Pose2::from({random.uniform(-3, 3), random.uniform(-2, 2)}, random.uniform(-kPi, kPi));
    const double bound =
        bounds.bound(points, middle.yaw, side_m, turn).at(bounds.place(middle.position()), 0.0);
    const Pose2 some = Pose2::from(
        middle.position() + Eigen::Vector2d(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)) * side_m,
        middle.yaw + random.uniform(-0.5, 0.5) * turn);
    EXPECT_LE(wall_score(walls, points, some, 0.1), bound + 1e-9);
  }
}

TEST(PlaceSearch, FindsThePlaceFromAnyHeading) {
  Random random(6);
  const OccupancyGrid map = test::drawn(test::room(), test::square_around({0.2, 0.1, 0.5}, 6.0));
  const PlaceSearch search(map, std::make_shared<WallField>(map));
  for (int i = 0; i < 15; ++i) {
    const Pose2 truth =
        Pose2::from({random.uniform(-1.5, 1.5), random.uniform(-1, 1)}, random.uniform(-kPi, kPi));
    const FoundPlaces found = search.find(seen_from(test::room(), truth, random));
    ASSERT_FALSE(found.fits.empty());
    EXPECT_TRUE(found.complete);
    EXPECT_LT(distance(found.fits.front().map_T_base, truth), 0.05);
    EXPECT_LT(std::abs(angle_between(found.fits.front().map_T_base.yaw, truth.yaw)), radians(1));
  }
}

TEST(PlaceSearch, ListsBothOfTwoTwins) {
  Random random(7);
  // A rectangle looks the same after half a turn.
  const test::Segments hall = test::rectangle(-4, -2.5, 4, 2.5);
  const OccupancyGrid map = test::drawn(hall, test::square_around({}, 6.0));
  const PlaceSearch search(map, std::make_shared<WallField>(map));
  const Pose2 truth{1.3, 0.6, 0.4}, twin{-1.3, -0.6, 0.4 - kPi};
  const FoundPlaces found = search.find(seen_from(hall, truth, random));
  for (const Pose2& place : {truth, twin})
    EXPECT_TRUE(std::ranges::any_of(found.fits, [&](const WallFit& fit) {
      return distance(fit.map_T_base, place) < 0.1 &&
             std::abs(angle_between(fit.map_T_base.yaw, place.yaw)) < 0.05 && fit.score > 0.9;
    })) << place.x;
}

TEST(PlaceSearch, FollowsACorridorOverItsWholeLength) {
  Random random(8);
  const OccupancyGrid map = test::drawn(test::bare_corridor(), test::square_around({}, 25.0));
  PlaceSearchOptions options;
  options.max_range_m = 6.0;  // within which the corridor has no end
  const PlaceSearch search(map, std::make_shared<WallField>(map), options);
  const FoundPlaces found = search.find(seen_from(test::bare_corridor(), {3, 0.2, 0.1}, random));
  for (double x = -18; x <= 18; x += 0.5)
    EXPECT_TRUE(std::ranges::any_of(found.fits, [&](const WallFit& fit) {
      return std::abs(fit.map_T_base.x - x) < 0.25 && std::abs(fit.map_T_base.y - 0.2) < 0.1 &&
             std::abs(fit.map_T_base.yaw - 0.1) < 0.05;
    })) << x;
}

TEST(PlaceSearch, SaysWhenAScanTellsNothing) {
  const OccupancyGrid map = test::drawn(test::room(), test::square_around({}, 6.0));
  const PlaceSearch search(map, std::make_shared<WallField>(map));
  for (const PointSet& points : {PointSet{}, PointSet(200, {1.0, 1.0}), PointSet(200, {1e6, 1e300})}) {
    const FoundPlaces found = search.find(points);
    EXPECT_FALSE(found.informative);
    EXPECT_TRUE(found.fits.empty());
  }
}

TEST(PlaceSearch, GivesTheSameAtAnyNumberOfThreads) {
  Random random(9);
  const OccupancyGrid map = test::drawn(test::room(), test::square_around({}, 6.0));
  const PlaceSearch search(map, std::make_shared<WallField>(map));
  const PointSet points = seen_from(test::room(), {1, 1, 1}, random);
  const FoundPlaces one = search.find(points, {1}), three = search.find(points, {3});
  ASSERT_EQ(one.fits.size(), three.fits.size());
  for (std::size_t i = 0; i < one.fits.size(); ++i) {
    EXPECT_EQ(one.fits[i].score, three.fits[i].score);
    EXPECT_EQ(one.fits[i].map_T_base.x, three.fits[i].map_T_base.x);
  }
}

}  // namespace
}  // namespace mstsl
