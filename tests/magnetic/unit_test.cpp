#include "mstsl/magnetic/unit.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

#include "test_support.hpp"

namespace mstsl {
namespace {

using test::must;

std::vector<double> norms_around(double median, Random& random) {
  std::vector<double> norms;
  for (int i = 0; i < 51; ++i) norms.push_back(median * random.uniform(0.97, 1.03));
  return norms;
}

TEST(FieldUnit, IsFoundForEveryStrengthThatTheEarthHas) {
  Random random(1);
  for (double strength_uT = 22.0; strength_uT <= 67.0; strength_uT += 0.5) {
    for (const FieldUnit unit : {FieldUnit::kTesla, FieldUnit::kMicrotesla, FieldUnit::kNanotesla,
                                 FieldUnit::kGauss, FieldUnit::kMilligauss}) {
      const auto norms = norms_around(strength_uT / microtesla_per(unit), random);
      EXPECT_EQ(must(detect_unit(norms)), unit) << strength_uT << " uT in " << to_string(unit);
    }
  }
}

TEST(FieldUnit, IsFoundForTheStrengthsOfBuildings) {
  Random random(2);
  for (double strength_uT = 16.0; strength_uT <= 75.0; strength_uT += 1.0)
    for (const FieldUnit unit : {FieldUnit::kTesla, FieldUnit::kMicrotesla, FieldUnit::kNanotesla,
                                 FieldUnit::kGauss, FieldUnit::kMilligauss})
      EXPECT_EQ(must(detect_unit(norms_around(strength_uT / microtesla_per(unit), random))), unit)
          << strength_uT;
  for (double strength_uT = 3.0; strength_uT <= 900.0; strength_uT += 1.0)
    EXPECT_EQ(must(detect_unit(norms_around(strength_uT * 1e-6, random))), FieldUnit::kTesla) << strength_uT;
}

TEST(FieldUnit, NormalisedReadingsHaveALengthOfAboutOne) {
  EXPECT_EQ(must(detect_unit(std::vector{1.0, 1.0, 1.0})), FieldUnit::kNormalised);
  EXPECT_EQ(must(detect_unit(std::vector{0.9, 1.1, 1.2})), FieldUnit::kNormalised);
}

TEST(FieldUnit, AFewBadReadingsDoNotMatter) {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(must(detect_unit(std::vector{0.0, nan, 45.0, 46.0, inf, 47.0, 1e9, 0.0, 44.0})),
            FieldUnit::kMicrotesla);
}

TEST(FieldUnit, IsRefusedWhereNoneFits) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& norms : std::vector<std::vector<double>>{
           {}, {nan, nan}, {0.0, 0.0, 0.0}, {1e-9}, {5e-7}, {0.01}, {5.0}, {5000.0}, {1e9}})
    EXPECT_FALSE(detect_unit(norms).ok());
}

}  // namespace
}  // namespace mstsl
