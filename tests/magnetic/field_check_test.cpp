#include "mstsl/magnetic/field_check.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace mstsl {
namespace {

/// 4 x 4 m, the same everywhere: (10, 0, -40) uT, SD 1, 2 and 4 uT.
FieldMap flat_map() {
  FieldMap map;
  map.geometry.resolution_m = 0.5;
  map.geometry.columns = map.geometry.rows = 8;
  map.mean_uT.assign(64, {10.0F, 0.0F, -40.0F});
  map.variance_uT2.assign(64, {1.0F, 4.0F, 16.0F});
  map.supported.assign(64, 1);
  return map;
}

TEST(FieldCheck, CountsErrorsInTheMapsOwnSigmas) {
  const std::vector<Fingerprint> drive = {{{1, 1}, {10.5, 3, -40}, 0, 0}, {{2, 2}, {7.5, 3, -31}, 0, 0}};
  const FieldCheck check = check_field_map(flat_map(), drive);
  EXPECT_EQ(check.score.errors, 2U);
  EXPECT_EQ(check.without_value, 0U);
  EXPECT_TRUE(check.mean_error_uT.isApprox(Eigen::Array3d(-1.0, 3.0, 4.5)));
  EXPECT_TRUE(check.score.rms_uT.square().isApprox(Eigen::Array3d(0.5 * (0.25 + 6.25), 9.0, 40.5)));
  EXPECT_TRUE(check.score.within_1_sigma.isApprox(Eigen::Array3d(0.5, 0.0, 0.5)));
  EXPECT_TRUE(check.score.within_2_sigma.isApprox(Eigen::Array3d(0.5, 1.0, 0.5)));
}

TEST(FieldCheck, PlacesOffTheMapAreCountedAndNotScored) {
  const FieldCheck check =
      check_field_map(flat_map(), std::vector<Fingerprint>{{{9, 1}, {10, 0, -40}, 0, 0}});
  EXPECT_EQ(check.score.errors, 0U);
  EXPECT_EQ(check.without_value, 1U);
  EXPECT_TRUE((check.mean_error_uT == 0.0).all());
}

}  // namespace
}  // namespace mstsl
