#include "mstsl/magnetic/survey_coverage.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

/// 10 x 4 m of ground in cells of 0.1 m; the first 4 m of it are covered, and a strip at the far end is wall.
FieldMap hall() {
  FieldMap map;
  map.geometry = {0.1, 100, 40, Pose2{1.0, 2.0, 0.0}};
  map.mean_uT.assign(4000, Eigen::Vector3f::Zero());
  map.variance_uT2.assign(4000, Eigen::Vector3f::Ones());
  map.supported.assign(4000, 0);
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    const Cell cell = map.geometry.cell(i);
    if (cell.column < 40) map.supported[i] = 1;
    if (cell.column >= 90) map.mean_uT[i].setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  return map;
}

TEST(SurveyCoverage, MeasuresGroundAndGaps) {
  const SurveyCoverage coverage = survey_coverage(hall());
  EXPECT_NEAR(coverage.ground_m2, 36.0, 1e-9);
  EXPECT_NEAR(coverage.covered_m2, 16.0, 1e-9);
  ASSERT_EQ(coverage.gaps.size(), 1U);
  EXPECT_NEAR(coverage.gaps[0].area_m2, 20.0, 1e-9);
  // The gap is 5 x 4 m: its inmost places are 2.5 m from either end.
  EXPECT_NEAR(coverage.gaps[0].inside_m.x(), 1.0 + 6.5, 0.2);
}

TEST(SurveyCoverage, PiecesAreCountedApartLargestFirstAndCrumbsNot) {
  FieldMap map = hall();
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    const Cell cell = map.geometry.cell(i);
    if (cell.column >= 60 && cell.column < 62) map.supported[i] = 1;  // divides the gap: 2 m and 2.8 m
    if (cell.column == 10 && cell.row < 20) map.supported[i] = 0;     // a crumb of 0.2 m2
  }
  const SurveyCoverage coverage = survey_coverage(map);
  ASSERT_EQ(coverage.gaps.size(), 2U);
  EXPECT_NEAR(coverage.gaps[0].area_m2, 11.2, 1e-9);
  EXPECT_NEAR(coverage.gaps[1].area_m2, 8.0, 1e-9);
}

TEST(SurveyCoverage, WaysDrivenOneWayOnlyAreToldFromThoseDrivenBothWays) {
  FieldMap map = hall();
  EXPECT_EQ(survey_coverage(map).one_way_share, 0.0);
  for (int i = 0; i < 40; ++i) map.fingerprints.push_back({{0.05 * i, 0.2}, Eigen::Vector3d::Zero(), 0.1, 0});
  EXPECT_EQ(survey_coverage(map).one_way_share, 1.0);
  for (int i = 0; i < 40; ++i) map.fingerprints.push_back({{0.05 * i, 5.2}, Eigen::Vector3d::Zero(), kPi, 0});
  EXPECT_EQ(survey_coverage(map).one_way_share, 1.0) << "that is another lane";
  // Back over the first half metre: 11 fingerprints of it, and those up to 0.3 m beyond (less 0.1 m aside).
  for (int i = 0; i <= 10; ++i)
    map.fingerprints.push_back({{0.05 * i, 0.3}, Eigen::Vector3d::Zero(), kPi, 0});
  EXPECT_NEAR(survey_coverage(map).one_way_share, 1.0 - (16.0 + 11.0) / 91.0, 1e-9);
}

}  // namespace
}  // namespace mstsl
