#include "mstsl/core/result.hpp"

#include <memory>

#include <gtest/gtest.h>

namespace mstsl {
namespace {

Result<std::unique_ptr<int>> positive(int value) {
  if (value <= 0) return Error("not positive");
  return std::make_unique<int>(value);
}

TEST(Result, HoldsAValueThatOnlyMoves) {
  auto result = positive(3);
  ASSERT_TRUE(result);
  const std::unique_ptr<int> taken = std::move(result).value();
  EXPECT_EQ(*taken, 3);
}

TEST(Result, AnErrorTellsItsPlaceOnTheWayUp) {
  const auto result = positive(-1);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().within("line 4").within("a.yaml").message(), "a.yaml: line 4: not positive");
}

TEST(Result, OfNothingIsSuccessUnlessToldOtherwise) {
  EXPECT_TRUE(Result<void>().ok());
  EXPECT_FALSE(Result<void>(Error("full disk")).ok());
}

}  // namespace
}  // namespace mstsl
