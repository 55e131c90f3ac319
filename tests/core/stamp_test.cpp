#include "mstsl/core/stamp.hpp"

#include <gtest/gtest.h>

namespace mstsl {
namespace {

TEST(Stamp, KeepsNanosecondsThatADoubleWouldLose) {
  const Stamp stamp = Stamp::from_parts(1'700'000'000, 123'456'789);
  EXPECT_EQ(stamp.ns, 1'700'000'000'123'456'789);
  EXPECT_DOUBLE_EQ((stamp + 1e-9) - stamp, 1e-9);
}

TEST(Stamp, IsOrdered) {
  EXPECT_LT(Stamp::from_seconds(1.0), Stamp::from_seconds(1.000000001));
  EXPECT_EQ(Stamp::from_seconds(-0.5).ns, -500'000'000);
}

}  // namespace
}  // namespace mstsl
