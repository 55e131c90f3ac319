#include "mstsl/datasets/floor_plan.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "test_support.hpp"

namespace mstsl::datasets {
namespace {

class FloorPlanFile : public testing::Test {
 protected:
  Result<FloorPlan> read(const std::string& text) {
    std::ofstream(file_) << text;
    return read_floor_plan(file_);
  }
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "plan.json";
};

TEST_F(FloorPlanFile, HoldsAnOuterPolygonAndBlocks) {
  const FloorPlan plan =
      test::must(read(R"({"in": [[0,0],[9,0],[9,5],[0,5]], "out": [[[2,1],[3,1],[3,2.5]]]})"));
  EXPECT_EQ(plan.outer.size(), 4U);
  ASSERT_EQ(plan.blocks.size(), 1U);
  EXPECT_EQ(plan.blocks[0][2], Eigen::Vector2d(3.0, 2.5));
  EXPECT_EQ(walls(plan).size(), 7U);
}

TEST_F(FloorPlanFile, SaysWhereItIsWrong) {
  const std::string corner = R"({"in": [[0,0],[9,"a"],[9,5]], "out": []})";
  EXPECT_NE(read(corner).error().message().find("in[1]"), std::string::npos);
  const std::string block = R"({"in": [[0,0],[9,0],[9,5]], "out": [[[1,1],[2,2]]]})";
  EXPECT_NE(read(block).error().message().find("out[0]"), std::string::npos);
}

TEST_F(FloorPlanFile, IsRefusedWithoutACrash) {
  for (const std::string text :
       {"", "{", "[]", "null", R"({"in": 3, "out": []})", R"({"in": [[0,0],[1,0],[1,1]]})",
        R"({"in": [[0,0],[1,0],[1,1]], "out": [3]})", R"({"in": [[0,0],[1],[1,1]], "out": []})",
        R"({"in": [[0,0],[1e999,0],[1,1]], "out": []})", "\xff\xfe"}) {
    const auto plan = read(text);
    ASSERT_FALSE(plan.ok()) << text;
    EXPECT_NE(plan.error().message().find("plan.json"), std::string::npos);
  }
}

}  // namespace
}  // namespace mstsl::datasets
