#include "mstsl/core/lazy.hpp"

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "mstsl/core/parallel.hpp"

namespace mstsl {
namespace {

TEST(Lazy, MakesItsValueOnceHoweverManyAsk) {
  std::atomic<int> made = 0;
  const Lazy<std::string> text([&made] {
    ++made;
    return std::string("made");
  });
  EXPECT_EQ(made, 0);
  parallel_for(100, {4}, [&](std::size_t) { EXPECT_EQ(*text, "made"); });
  EXPECT_EQ(text->size(), 4u);
  EXPECT_EQ(made, 1);
}

TEST(Lazy, LetsGoOfWhatItsMakerHeld) {
  auto held = std::make_shared<int>(7);
  const std::weak_ptr<int> watch = held;
  const Lazy<int> number([held = std::move(held)] { return *held; });
  EXPECT_EQ(*number, 7);
  EXPECT_TRUE(watch.expired());
}

TEST(Lazy, TriesAgainAfterItsMakerFailed) {
  int tries = 0;
  const Lazy<int> number([&tries] {
    if (++tries == 1) throw std::runtime_error("not yet");
    return tries;
  });
  EXPECT_THROW(*number, std::runtime_error);
  EXPECT_EQ(*number, 2);
}

}  // namespace
}  // namespace mstsl
