#include "mstsl/core/crew.hpp"

#include <gtest/gtest.h>

#include "test_support.hpp"
#include "thread_crew.hpp"

namespace mstsl {
namespace {

using test::must;

TEST(Crew, PortionsHoldEachPieceOnceAndAreAlikeInSize) {
  for (const int size : {1, 2, 3, 7})
    for (std::size_t count = 0; count < 40; ++count) {
      std::size_t next = 0;
      for (int rank = 0; rank < size; ++rank) {
        const Portion portion = portion_of(count, {rank, size, {}});
        EXPECT_EQ(portion.first, next);
        EXPECT_GE(portion.last - portion.first, count / static_cast<std::size_t>(size));
        EXPECT_LE(portion.last - portion.first, count / static_cast<std::size_t>(size) + 1);
        next = portion.last;
      }
      EXPECT_EQ(next, count);
    }
}

TEST(Crew, EachLearnsWhatAllHave) {
  std::vector<std::vector<std::string>> learned(3);
  test::as_crew(3, [&](const Crew& crew) {
    const std::string mine(static_cast<std::size_t>(crew.rank), 'x');  // the first has nothing to say
    learned[static_cast<std::size_t>(crew.rank)] = must(pooled(crew, mine));
  });
  for (const auto& all : learned) EXPECT_EQ(all, (std::vector<std::string>{"", "x", "xx"}));
  EXPECT_EQ(must(pooled({}, std::string("alone"))), std::vector<std::string>{"alone"});
}

TEST(Crew, OneThatFailsEndsItForAll) {
  std::vector<std::string> said(3);
  test::as_crew(3, [&](const Crew& crew) {
    const auto all =
        pooled(crew, crew.rank == 1 ? Result<std::string>(Error("disk full")) : std::string("good"));
    if (!all) said[static_cast<std::size_t>(crew.rank)] = all.error().message();
  });
  EXPECT_EQ(said, (std::vector<std::string>(3, "disk full")));
  EXPECT_FALSE(pooled({}, Error("alone")));
}

}  // namespace
}  // namespace mstsl
