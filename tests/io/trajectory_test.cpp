#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"
#include "mstsl/io/file_bytes.hpp"
#include "mstsl/io/truth.hpp"
#include "mstsl/io/tum.hpp"

#include "mutations.hpp"
#include "test_support.hpp"

namespace mstsl::io {
namespace {

namespace fs = std::filesystem;
using test::must;

std::vector<PoseReading> poses() {
  Random random(1);
  std::vector<PoseReading> all;
  for (int i = 0; i < 40; ++i)
    all.push_back({Stamp{1'700'000'000'123'456'789 + std::int64_t{25'000'000} * i},
                   Pose2{random.normal(0, 40), random.normal(0, 40), random.uniform(-3.1, 3.1)}});
  return all;
}

fs::path put(const test::TemporaryFolder& folder, const std::string& text) {
  std::ofstream(folder.path() / "file", std::ios::binary) << text;
  return folder.path() / "file";
}

template <typename Read>
std::string error_of(Read read, const std::string& text) {
  const test::TemporaryFolder folder;
  const auto result = read(put(folder, text));
  return result ? "no error" : result.error().message();
}

TEST(Truth, ReadsBackEveryDigit) {
  const test::TemporaryFolder folder;
  must(write_truth(poses(), folder.path() / "truth.csv"));
  const auto back = must(read_truth(folder.path() / "truth.csv"));
  ASSERT_EQ(back.size(), poses().size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_EQ(back[i].stamp, poses()[i].stamp);
    EXPECT_EQ(back[i].map_T_base.x, poses()[i].map_T_base.x);
    EXPECT_EQ(back[i].map_T_base.y, poses()[i].map_T_base.y);
    EXPECT_EQ(back[i].map_T_base.yaw, poses()[i].map_T_base.yaw);
  }
  const std::string text = must(read_file(folder.path() / "truth.csv", 10'000));
  EXPECT_TRUE(text.starts_with("t,x,y,yaw\n1700000000.123456789,")) << text.substr(0, 60);
}

TEST(Truth, ReadsOtherPeoplesLineEndsAndStamps) {
  const test::TemporaryFolder folder;
  const auto back = must(read_truth(put(folder, "t,x,y,yaw\r\n-0.5,1,+2.0,3e-1\r\n\r\n1.7e9,1,2,7.0\n")));
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0].stamp.ns, -500'000'000);
  EXPECT_EQ(back[0].map_T_base.yaw, 0.3);
  EXPECT_EQ(back[1].stamp.ns, 1'700'000'000'000'000'000);
  EXPECT_NEAR(back[1].map_T_base.yaw, 7.0 - 2 * M_PI, 1e-12);
}

TEST(Truth, NamesTheLineThatIsWrong) {
  EXPECT_NE(error_of(read_truth, "x,y\n1,2\n").find("line 1 is not 't,x,y,yaw'"), std::string::npos);
  EXPECT_NE(error_of(read_truth, "").find("line 1"), std::string::npos);
  EXPECT_NE(error_of(read_truth, "t,x,y,yaw\n").find("no row"), std::string::npos);
  EXPECT_NE(error_of(read_truth, "t,x,y,yaw\n1,2,3\n").find("line 2 has 3 fields"), std::string::npos);
  EXPECT_NE(error_of(read_truth, "t,x,y,yaw\n1,2,3,nan\n").find("line 2 holds something other"),
            std::string::npos);
  EXPECT_NE(error_of(read_truth, "t,x,y,yaw\n1e30,2,3,0\n").find("line 2 holds something other"),
            std::string::npos);
  EXPECT_NE(error_of(read_truth, "t,x,y,yaw\n1,2,3,0x\n").find("line 2 holds something other"),
            std::string::npos);
  EXPECT_NE(error_of(read_truth, "t,x,y,yaw\n2,0,0,0\n1,0,0,0\n").find("line 3 goes back in time"),
            std::string::npos);
  EXPECT_FALSE(write_truth({{Stamp{}, Pose2{NAN, 0, 0}}}, "/nowhere/truth.csv"));
}

TEST(Tum, ReadsBackWhatItWrote) {
  const test::TemporaryFolder folder;
  TumWriter writer = must(TumWriter::open(folder.path() / "t.tum"));
  for (const PoseReading& pose : poses()) must(writer.write(pose));
  EXPECT_FALSE(writer.write({Stamp{}, Pose2{0, NAN, 0}}));
  must(writer.close());
  const auto back = must(read_tum(folder.path() / "t.tum"));
  ASSERT_EQ(back.size(), poses().size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_EQ(back[i].stamp, poses()[i].stamp);
    EXPECT_EQ(back[i].map_T_base.x, poses()[i].map_T_base.x);
    EXPECT_NEAR(back[i].map_T_base.yaw, poses()[i].map_T_base.yaw, 1e-15);
  }
}

TEST(Tum, NamesTheLineThatIsWrong) {
  EXPECT_EQ(error_of(read_tum, "# a comment\n\n1.0  2 3 0 0 0 0 1\n"), "no error");
  EXPECT_NE(error_of(read_tum, "1 2 3\n").find("line 1 has 3 fields"), std::string::npos);
  EXPECT_NE(error_of(read_tum, "#\n1 2 3 0 0 0 0 0\n").find("line 2 has a quaternion of length 0"),
            std::string::npos);
  EXPECT_NE(error_of(read_tum, "1 2 3 inf 0 0 0 1\n").find("eight finite numbers"), std::string::npos);
}

TEST(Trajectories, AnswerToEveryDamage) {
  int good = 0;
  int bad = 0;
  const test::TemporaryFolder folder;
  test::for_each_damage("t,x,y,yaw\n0.5,1.25,-3,0.1\n1.5,2e3,4,-1\n", 400, Random(2),
                        [&](const std::string& text) { (read_truth(put(folder, text)) ? good : bad) += 1; });
  test::for_each_damage("# c\n0.5 1.25 -3 0 0 0 0.6 0.8\n", 400, Random(3),
                        [&](const std::string& text) { (read_tum(put(folder, text)) ? good : bad) += 1; });
  EXPECT_GT(good, 50);
  EXPECT_GT(bad, 200);
}

}  // namespace
}  // namespace mstsl::io
