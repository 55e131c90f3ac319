#include "mstsl/datasets/path_field.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace mstsl::datasets {
namespace {

Fingerprint row(double x_m, double y_m, double field_uT) {
  Fingerprint row;
  row.position_m = {x_m, y_m};
  row.field_uT = {field_uT, 2.0 * field_uT, -field_uT};
  return row;
}

TEST(PathField, IsTheRowsOwnAtEachRow) {
  const PathField field({row(0, 0, 10), row(1, 0, 20), row(1, 1, 40)});
  for (const Fingerprint& r : field.rows()) EXPECT_EQ(field.field_uT(r.position_m), r.field_uT);
}

TEST(PathField, IsLinearBetweenRowsAndConstantBesideThePath) {
  const PathField field({row(0, 0, 10), row(1, 0, 20)});
  EXPECT_NEAR(field.field_uT({0.25, 0.0}).x(), 12.5, 1e-12);
  EXPECT_NEAR(field.field_uT({0.25, 0.4}).x(), 12.5, 1e-12);
}

TEST(PathField, EndsWithItsFirstAndLastRow) {
  const PathField field({row(0, 0, 10), row(1, 0, 20)});
  EXPECT_EQ(field.field_uT({-5.0, 0.0}).x(), 10.0);
  EXPECT_EQ(field.field_uT({7.0, 1.0}).x(), 20.0);
}

TEST(PathField, AcceptsASingleRowAndRepeatedPlaces) {
  EXPECT_EQ(PathField({row(0, 0, 10)}).field_uT({3.0, 4.0}).x(), 10.0);
  const PathField field({row(0, 0, 10), row(0, 0, 30), row(1, 0, 30)});
  EXPECT_TRUE(field.field_uT({0.0, 0.0}).allFinite());
  EXPECT_NEAR(field.field_uT({0.5, 0.0}).x(), 30.0, 1e-12);
}

}  // namespace
}  // namespace mstsl::datasets
