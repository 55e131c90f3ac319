#include "mstsl/core/stamp.hpp"

#include <cstdint>
#include <limits>

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

TEST(Stamp, NeitherDifferenceNorSumOfTheMostDistantStampsOverflows) {
  const Stamp first{std::numeric_limits<std::int64_t>::min()}, last{std::numeric_limits<std::int64_t>::max()};
  EXPECT_NEAR(last - first, 1.8446744073709552e10, 1.0);
  EXPECT_NEAR(first - last, -1.8446744073709552e10, 1.0);
  EXPECT_EQ(last + 1.0, last);
  EXPECT_EQ(first + -1.0, first);
  EXPECT_LT(first, first + 1.0);
}

}  // namespace
}  // namespace mstsl
