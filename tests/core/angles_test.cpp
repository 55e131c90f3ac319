#include "mstsl/core/angles.hpp"

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

TEST(Angles, WrappingKeepsTheDirectionAndTheRange) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const double angle = random.uniform(-100.0, 100.0);
    const double wrapped = wrap_angle(angle);
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-12);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-12);
  }
}

TEST(Angles, HalfATurnIsWrittenOneWayOnly) {
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_EQ(wrap_angle(0.0), 0.0);
}

TEST(Angles, TheTurnBetweenIsTheShortOne) {
  EXPECT_NEAR(angle_between(radians(170), radians(-170)), radians(20), 1e-12);
  EXPECT_NEAR(angle_between(radians(-170), radians(170)), radians(-20), 1e-12);
}

}  // namespace
}  // namespace mstsl
