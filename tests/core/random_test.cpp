#include "mstsl/core/random.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace mstsl {
namespace {

TEST(Random, TheSameSeedGivesTheSameNumbers) {
  Random a(7), b(7);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.normal(), b.normal());
}

TEST(Random, AForkDoesNotDependOnWhatWasDrawn) {
  Random a(7), b(7);
  for (int i = 0; i < 10; ++i) a.uniform();
  EXPECT_EQ(a.fork(3).uniform(), b.fork(3).uniform());
  EXPECT_NE(a.fork(3).uniform(), b.fork(4).uniform());
}

TEST(Random, NormalNumbersHaveTheMomentsOfOne) {
  Random random(8);
  constexpr int kCount = 200'000;
  double sum = 0, squares = 0, fourth = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    sum += x, squares += x * x, fourth += x * x * x * x;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(squares / kCount, 1.0, 0.015);
  EXPECT_NEAR(fourth / kCount, 3.0, 0.1);
}

TEST(Random, IndexReachesAllAndNoMore) {
  Random random(9);
  std::vector<int> hits(5, 0);
  for (int i = 0; i < 1000; ++i) ++hits.at(random.index(5));
  for (const int h : hits) EXPECT_GT(h, 140);
}

}  // namespace
}  // namespace mstsl
