#include "mstsl/core/parallel.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

std::vector<double> work_with(int threads) {
  const Random random(5);
  std::vector<double> out(1000);
  parallel_for(out.size(), {threads}, [&](std::size_t i) { out[i] = random.fork(i).normal(); });
  return out;
}

TEST(Parallel, GivesTheSameAtAnyNumberOfThreads) {
  const auto one = work_with(1);
  EXPECT_EQ(one, work_with(2));
  EXPECT_EQ(one, work_with(0));
}

TEST(Parallel, DoesNothingForNothing) {
  parallel_for(0, {2}, [](std::size_t) { FAIL(); });
}

}  // namespace
}  // namespace mstsl
