#include "mstsl/scan/likelihood_field.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "mstsl/scan/likelihood_pyramid.hpp"

#include "segment_world.hpp"

namespace mstsl {
namespace {

LikelihoodField room_field(const Pose2& map_T_grid = {}) {
  return LikelihoodField(test::drawn(test::room(), test::square_around(map_T_grid, 6.0)));
}

TEST(LikelihoodField, IsTheGaussianOfTheDistanceToTheNearestWallCell) {
  OccupancyGrid map(test::square_around({}, 1.0), CellState::kFree);
  map[{20, 20}] = CellState::kOccupied;
  const LikelihoodField field(map, {.sigma_m = 0.1});
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 40; ++column) {
      const double distance_m = 0.05 * std::hypot(column - 20, row - 20);
      const double expected = distance_m < 0.3 - 1e-6 ? std::exp(-0.5 * std::pow(distance_m / 0.1, 2)) : 0.0;
      EXPECT_NEAR((field.values()[{column, row}]), expected, 1e-6);
    }
  }
}

TEST(LikelihoodField, IsNeverNarrowerThanItsCellsCanShow) {
  const OccupancyGrid coarse(test::square_around({}, 2.0, 0.2), CellState::kFree);
  EXPECT_NEAR(LikelihoodField(coarse, {.sigma_m = 0.01}).sigma_m(), 0.3, 1e-12);
  EXPECT_NEAR(LikelihoodField(coarse, {.sigma_m = 0.5}).sigma_m(), 0.5, 1e-12);
}

TEST(LikelihoodField, IsItsOwnValueAtCellCentres) {
  const LikelihoodField field = room_field();
  for (std::size_t i = 0; i < field.geometry().size(); i += 7) {
    const Cell cell = field.geometry().cell(i);
    EXPECT_NEAR(field.sample({cell.column + 0.5, cell.row + 0.5}).value, field.values()[cell], 1e-6);
  }
}

TEST(LikelihoodField, HasTheSlopeThatDifferencesShow) {
  const LikelihoodField field = room_field({0.3, 0.2, 0.7});
  Random random(1);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d p(random.uniform(-5, field.geometry().columns + 5),
                            random.uniform(-5, field.geometry().rows + 5));
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
      const double difference = (field.sample(p + step).value - field.sample(p - step).value) / (2 * kStep);
      EXPECT_NEAR(field.sample(p).gradient_per_cell[axis], difference, 1e-6);
    }
  }
}

TEST(LikelihoodField, IsZeroFarFromTheMap) {
  const LikelihoodField field = room_field();
  for (const double far : {-3.0, -1e9, 1e9, 1e300}) {
    EXPECT_EQ(field.sample({far, 10}).value, 0.0);
    EXPECT_EQ(field.sample({10, far}).gradient_per_cell.norm(), 0.0);
  }
  EXPECT_EQ(LikelihoodField(OccupancyGrid()).sample({0, 0}).value, 0.0);
}

TEST(LikelihoodPyramid, HoldsTheMaximumOfEachWindow) {
  Random random(2);
  OccupancyGrid map(test::square_around({}, 0.8), CellState::kFree);
  for (CellState& state : map.values()) state = random.chance(0.01) ? CellState::kOccupied : CellState::kFree;
  const LikelihoodField field(map);
  const LikelihoodPyramid pyramid(field, 5);
  for (int level = 0; level < 5; ++level) {
    const int side = 1 << level;
    for (int row = -40; row < 40; ++row) {
      for (int column = -40; column < 40; ++column) {
        int expected = 0;
        for (int r = row; r < row + side; ++r) {
          for (int c = column; c < column + side; ++c) {
            if (field.values().contains({c, r}))
              expected = std::max(expected, static_cast<int>(std::lround(255 * field.values()[{c, r}])));
          }
        }
        ASSERT_EQ(pyramid.at(level, {column, row}), expected) << level << ": " << column << ", " << row;
      }
    }
  }
}

}  // namespace
}  // namespace mstsl
