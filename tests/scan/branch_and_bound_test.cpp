#include "mstsl/scan/branch_and_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "segment_world.hpp"

namespace mstsl {
namespace {

/// A pose of the lattice with its place in the order of answers: score, nearness to the window's centre, then
/// order.
struct Candidate {
  ScoredPose pose;
  std::array<int, 5> rank;  ///< smaller comes first
};

/// Scores every pose of the lattice and keeps the best, then the best of those not near it, and so on.
std::vector<ScoredPose> brute_force(const LikelihoodPyramid& map, const PointSet& points,
                                    const SearchWindow& window, const PoseSearchOptions& options) {
  const GridGeometry& geometry = map.geometry();
  const int reach_x = static_cast<int>(std::ceil(window.reach_m.x() / geometry.resolution_m - 1e-9));
  const int reach_y = static_cast<int>(std::ceil(window.reach_m.y() / geometry.resolution_m - 1e-9));
  const int turns = static_cast<int>(std::ceil(window.reach_rad / options.yaw_step_rad));
  std::vector<Candidate> candidates;
  for (int turn = -turns; turn <= turns; ++turn) {
    const double yaw = window.center.yaw + turn * options.yaw_step_rad;
    for (int y = -reach_y; y <= reach_y; ++y) {
      for (int x = -reach_x; x <= reach_x; ++x) {
        const Eigen::Vector2d shift =
            geometry.map_T_grid.rotation() * Eigen::Vector2d(x, y) * geometry.resolution_m;
        int sum = 0;
        for (const Eigen::Vector2d& p : points) {
          const Cell cell = geometry.cell_at(Pose2::from(window.center.position(), yaw) * p);
          sum += map.at(0, {cell.column + x, cell.row + y});
        }
        const double score = sum / (255.0 * static_cast<double>(points.size()));
        const int order = turn > 0 ? 2 * turn - 1 : -2 * turn;
        if (score < options.min_score) continue;
        candidates.push_back({{Pose2::from(window.center.position() + shift, yaw), score},
                              {-sum, x * x + y * y, order, y, x}});
      }
    }
  }
  std::ranges::sort(candidates, {}, &Candidate::rank);
  std::vector<ScoredPose> answers;
  for (const auto& [pose, rank] : candidates) {
    const bool near = std::any_of(answers.begin(), answers.end(), [&, &pose = pose](const ScoredPose& a) {
      return distance(a.map_T_base, pose.map_T_base) < options.distinct_m &&
             std::abs(angle_between(a.map_T_base.yaw, pose.map_T_base.yaw)) < options.distinct_rad;
    });
    if (!near && answers.size() < options.max_answers) answers.push_back(pose);
  }
  return answers;
}

struct Place {
  LikelihoodPyramid map;
  PointSet points;
  Pose2 truth;
};

Place place_in_room(Random& random, const Pose2& map_T_room, int levels = 7) {
  const Pose2 in_room{random.uniform(-1.4, 1.4), random.uniform(-1.3, 1.3), random.uniform(-kPi, kPi)};
  const Pose2 truth = map_T_room * in_room;
  const test::Segments walls = test::moved(map_T_room, test::room());
  const LaserScan scan = test::scan_of(walls, truth, random, {.beams = 271, .noise_m = 0.01});
  const PointSet points = at_most(thinned(points_in_base(scan, Eigen::Isometry3d::Identity()), 0.1), 60);
  const LikelihoodField field(test::drawn(walls, test::square_around(map_T_room * Pose2{0, 0, 0.4}, 5.5)));
  return {LikelihoodPyramid(field, levels), points, truth};
}

TEST(SearchPoses, GivesTheSameAnswersAsTryingAll) {
  Random random(1);
  for (int trial = 0; trial < 12; ++trial) {
    const Place place = place_in_room(random, {3, -2, 0.8}, 1 + static_cast<int>(random.index(7)));
    const Pose2 center =
        place.truth * Pose2{random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(-0.2, 0.2)};
    const SearchWindow window{
        center, {random.uniform(0, 0.8), random.uniform(0, 0.8)}, random.uniform(0, 0.4)};
    const PoseSearchOptions options{.min_score = random.uniform(0, 0.3),
                                    .distinct_m = 0.3,
                                    .distinct_rad = 0.1,
                                    .max_answers = 1 + random.index(5),
                                    .yaw_step_rad = 0.02};
    const auto expected = brute_force(place.map, place.points, window, options);
    const auto found = search_poses(place.map, place.points, window, options);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i].score, expected[i].score, 1e-12) << "answer " << i << " of trial " << trial;
      EXPECT_NEAR(distance(found[i].map_T_base, expected[i].map_T_base), 0, 1e-9);
      EXPECT_NEAR(angle_between(found[i].map_T_base.yaw, expected[i].map_T_base.yaw), 0, 1e-9);
    }
  }
}

TEST(SearchPoses, FindsTheTruthInTheWholeMap) {
  Random random(2);
  for (int trial = 0; trial < 5; ++trial) {
    const Place place = place_in_room(random, {3, -2, 0.8});
    const auto found = search_poses(place.map, place.points, SearchWindow::whole(place.map.geometry()));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_LT(distance(found[0].map_T_base, place.truth), 0.08);
    EXPECT_LT(std::abs(angle_between(found[0].map_T_base.yaw, place.truth.yaw)), radians(1.5));
    EXPECT_GT(found[0].score, 0.9);
  }
}

TEST(SearchPoses, GivesBothAnswersInASymmetricPlace) {
  const test::Segments walls = test::rectangle(-3, -2, 3, 2);
  Random random(3);
  const Pose2 truth{1.0, 0.5, 0.3}, twin{-1.0, -0.5, 0.3 + kPi};
  const PointSet points = at_most(
      thinned(points_in_base(test::scan_of(walls, truth, random), Eigen::Isometry3d::Identity()), 0.1), 150);
  const LikelihoodPyramid map(LikelihoodField(test::drawn(walls, test::square_around({}, 4))));
  const auto found =
      search_poses(map, points, SearchWindow::whole(map.geometry()), {.min_score = 0.9, .max_answers = 5});
  ASSERT_EQ(found.size(), 2U);
  for (const Pose2& pose : {truth, twin}) {
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const ScoredPose& f) {
      return distance(f.map_T_base, pose) < 0.08 &&
             std::abs(angle_between(f.map_T_base.yaw, pose.yaw)) < 0.03;
    }));
  }
}

TEST(SearchPoses, MovesWithTheWorld) {
  // Map and window moved alike by any rigid motion: the answer moves along and the score stays.
  Random random(4);
  for (int trial = 0; trial < 5; ++trial) {
    const Place place = place_in_room(random, {});
    const Pose2 motion{random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-3, 3)};
    GridGeometry geometry = test::square_around({0, 0, 0.4}, 5.5);
    const OccupancyGrid map = test::drawn(test::room(), geometry);
    geometry.map_T_grid = motion * geometry.map_T_grid;
    const OccupancyGrid moved_map(geometry, map.values());
    const SearchWindow window{place.truth * Pose2{0.22, -0.13, 0.05}, {0.5, 0.5}, 0.2};
    const SearchWindow moved_window{motion * window.center, window.reach_m, window.reach_rad};
    const auto found = search_poses(LikelihoodPyramid(LikelihoodField(map)), place.points, window);
    const auto moved =
        search_poses(LikelihoodPyramid(LikelihoodField(moved_map)), place.points, moved_window);
    ASSERT_TRUE(found.size() == 1 && moved.size() == 1);
    EXPECT_NEAR(distance(motion * found[0].map_T_base, moved[0].map_T_base), 0, 1e-6);
    EXPECT_NEAR(found[0].score, moved[0].score, 1e-3);  // a point on a cell's border may fall to either side
  }
}

TEST(SearchPoses, PrefersTheWindowsCentreAmongEquals) {
  const LikelihoodPyramid map(
      LikelihoodField(test::drawn(test::bare_corridor(), test::square_around({}, 20))));
  Random random(5);
  const PointSet points =
      at_most(points_in_base(test::scan_of(test::bare_corridor(), {}, random, {.range_max_m = 5}),
                             Eigen::Isometry3d::Identity()),
              100);
  const auto found = search_poses(map, points, {{0.0, 0.0, 0.0}, {3, 0.2}, 0.1});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].map_T_base.x, 0.0, 1e-9);
}

TEST(SearchPoses, FindsNothingWhereNothingFits) {
  Random random(6);
  const Place place = place_in_room(random, {});
  const SearchWindow window{place.truth, {1, 1}, 0.2};
  EXPECT_TRUE(search_poses(place.map, {}, window).empty());
  EXPECT_TRUE(search_poses(place.map, PointSet(5, {1e300, -1e300}), window).empty());
  EXPECT_TRUE(search_poses(place.map, place.points, {{1e8, 0, 0}, {1, 1}, 0.2}).empty());
  EXPECT_TRUE(search_poses(place.map, place.points, window, {.min_score = 1.01}).empty());
  EXPECT_TRUE(
      search_poses(LikelihoodPyramid(LikelihoodField(OccupancyGrid())), place.points, window).empty());
}

TEST(SearchWindow, HoldsThreeSigmaAlongTheGridsAxes) {
  const GridGeometry geometry = test::square_around({0, 0, radians(90)}, 5);
  Eigen::Matrix3d covariance = Eigen::Vector3d(0.04, 0.01, 0.0025).asDiagonal();
  const SearchWindow window = SearchWindow::around({1, 2, 0.5}, covariance, 3.0, geometry);
  EXPECT_NEAR(window.reach_m.x(), 0.3, 1e-9);  // the grid's x axis is the map's y axis
  EXPECT_NEAR(window.reach_m.y(), 0.6, 1e-9);
  EXPECT_NEAR(window.reach_rad, 0.15, 1e-9);
}

}  // namespace
}  // namespace mstsl
