#include "mstsl/magnetic/field_sampler.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A smooth field of some uT around (20, 0, 40), the same unsureness everywhere.
FieldMap smooth_map(float variance_uT2, const Pose2& map_T_grid = {2, 3, 0.4}) {
  FieldMap map;
  map.geometry = {.resolution_m = 0.1, .columns = 120, .rows = 80, .map_T_grid = map_T_grid};
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    const Cell cell = map.geometry.cell(i);
    const float x = 0.1F * static_cast<float>(cell.column), y = 0.1F * static_cast<float>(cell.row);
    map.mean_uT.emplace_back(20.0F + 6.0F * std::sin(x), 5.0F * std::cos(0.8F * y),
                             40.0F + 4.0F * std::sin(x + y));
    map.variance_uT2.push_back(Eigen::Vector3f::Constant(variance_uT2));
    map.supported.push_back(1);
  }
  return map;
}

TEST(FieldSampler, SaysWhatTheMapSays) {
  const FieldMap map = smooth_map(1.5F);
  const FieldSampler sampler(map);
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector2d at = map.geometry.to_map({random.uniform(1, 118), random.uniform(1, 78)});
    const auto sample = sampler.sample(at);
    const auto direct = map.at(at);
    ASSERT_TRUE(sample.known && direct);
    EXPECT_LT((sample.mean_uT - direct->mean_uT).norm(), 1e-4);
    EXPECT_LT((sample.variance_uT2 - Eigen::Vector3d::Constant(1.5)).norm(), 1e-5);
  }
}

TEST(FieldSampler, ItsSlopeIsHowTheMeanChanges) {
  const FieldMap map = smooth_map(1.0F);
  const FieldSampler sampler(map);
  Random random(2);
  constexpr double kStep_m = 0.004;
  for (int i = 0; i < 300; ++i) {
    // Well inside a cell of centres, where the mean is smooth.
    const Eigen::Vector2d cells(std::floor(random.uniform(2, 116)) + random.uniform(0.6, 1.4),
                                std::floor(random.uniform(2, 76)) + random.uniform(0.6, 1.4));
    const Eigen::Vector2d at = map.geometry.to_map(cells);
    const auto here = sampler.sample(at);
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep_m * Eigen::Vector2d::Unit(axis);
      const Eigen::Vector3d change =
          (sampler.sample(at + step).mean_uT - sampler.sample(at - step).mean_uT) / (2 * kStep_m);
      EXPECT_LT((change - here.slope_uT_m.col(axis)).norm(), 0.15);
    }
  }
}

TEST(FieldSampler, KnowsTheBuildingWhereTheMapKnowsNothing) {
  FieldMap map = smooth_map(1.0F);
  for (int column = 50; column < 60; ++column)
    for (int row = 0; row < 80; ++row) map.mean_uT[map.geometry.index({column, row})].setConstant(kNan);
  const FieldSampler sampler(map);
  for (const Eigen::Vector2d& at :
       {map.geometry.to_map({55, 40}), Eigen::Vector2d(1e9, 0), Eigen::Vector2d(kNan, 0)}) {
    const auto sample = sampler.sample(at);
    EXPECT_FALSE(sample.known);
    EXPECT_EQ(sample.mean_uT, sampler.mean_uT());
    EXPECT_EQ(sample.variance_uT2, Eigen::Vector3d(sampler.spread_uT().cwiseAbs2()));
  }
}

/// Beside a post a map claims (60, -50, 90) +- 50 uT.
FieldMap map_beside_a_post() {
  FieldMap map = smooth_map(1.0F);
  for (int column = 60; column < 66; ++column)
    for (int row = 40; row < 46; ++row) {
      map.mean_uT[map.geometry.index({column, row})] = {60, -50, 90};
      map.variance_uT2[map.geometry.index({column, row})].setConstant(2500);
    }
  return map;
}

TEST(FieldSampler, IsNowhereLessSureThanWithoutAMap) {
  const FieldMap map = map_beside_a_post();
  const FieldSampler sampler(map);
  const Eigen::Vector3d most = sampler.spread_uT().cwiseAbs2() * (1 + 1e-5);
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const auto sample = sampler.sample(map.geometry.to_map({random.uniform(0, 120), random.uniform(0, 80)}));
    EXPECT_TRUE((sample.variance_uT2.array() <= most.array()).all());
  }
  const auto beside = sampler.sample(map.geometry.to_map({63, 43}));
  EXPECT_LT((beside.mean_uT - sampler.mean_uT()).norm(), 5.0)
      << "what it claims there is worth next to nothing";
  EXPECT_LT((sampler.sample(map.geometry.to_map({20.5, 20.5})).mean_uT -
             map.mean_uT[map.geometry.index({20, 20})].cast<double>())
                .norm(),
            1e-4)
      << "elsewhere the map counts as it is";
}

TEST(FieldSampler, OfAFieldThatIsTheSameEverywhereKeepsItsClaim) {
  FieldMap map = smooth_map(2.0F);
  for (Eigen::Vector3f& mean : map.mean_uT) mean = {20, 0, 40};
  const auto sample = FieldSampler(map).sample(map.geometry.to_map({50, 40}));
  EXPECT_EQ(sample.mean_uT, Eigen::Vector3d(20, 0, 40));
  EXPECT_EQ(sample.variance_uT2, Eigen::Vector3d::Constant(2.0));
}

TEST(FieldSampler, MeasuresHowFastTheFieldChanges) {
  FieldMap slow = smooth_map(1.0F), fast = smooth_map(1.0F);
  for (std::size_t i = 0; i < fast.geometry.size(); ++i) {
    const Cell cell = fast.geometry.cell(i);
    fast.mean_uT[i].x() = 20.0F + 6.0F * std::sin(0.6F * static_cast<float>(cell.column));
    fast.mean_uT[i].y() = 5.0F * std::cos(0.6F * static_cast<float>(cell.row));
    fast.mean_uT[i].z() = 40.0F + 4.0F * std::sin(0.6F * static_cast<float>(cell.column + cell.row));
  }
  EXPECT_GT(FieldSampler(slow).length_m(), 2 * FieldSampler(fast).length_m());
}

}  // namespace
}  // namespace mstsl
