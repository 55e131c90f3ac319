#include "mstsl/datasets/number_columns.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "test_support.hpp"

namespace mstsl::datasets {
namespace {

class NumberColumns : public testing::Test {
 protected:
  Result<std::vector<std::vector<double>>> read(std::string_view text) {
    std::ofstream(file_, std::ios::binary) << text;
    constexpr std::array<std::string_view, 2> kNames = {"y", "x"};
    return read_number_columns(file_, kNames);
  }
  std::string problem(std::string_view text) {
    const auto columns = read(text);
    return columns.ok() ? "none" : columns.error().message();
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "walk.csv";
};

TEST_F(NumberColumns, AreFoundByNameInTheOrderAskedFor) {
  const auto columns = test::must(read("x,other,y\n1.5,9,-2e3\n\n2.5,not a number,4\n"));
  EXPECT_EQ(columns[0], (std::vector<double>{-2e3, 4.0}));
  EXPECT_EQ(columns[1], (std::vector<double>{1.5, 2.5}));
}

TEST_F(NumberColumns, AcceptBlanksAHashAndDosLineEnds) {
  const auto columns = test::must(read("# x, y\r\n 1 ,\t2\r\n3,4"));
  EXPECT_EQ(columns[0], (std::vector<double>{2.0, 4.0}));
}

TEST_F(NumberColumns, ListThoseThereWhenOneIsMissing) {
  const std::string said = problem("x,z\n1,2\n");
  EXPECT_NE(said.find("no column 'y'"), std::string::npos) << said;
  EXPECT_NE(said.find("x, z"), std::string::npos) << said;
}

TEST_F(NumberColumns, NameTheFileAndLineOfARowThatIsCutOff) {
  const std::string said = problem("x,y\n1,2\n3");
  EXPECT_NE(said.find("walk.csv"), std::string::npos) << said;
  EXPECT_NE(said.find("line 3"), std::string::npos) << said;
}

TEST_F(NumberColumns, RefuseWhatIsNoFiniteNumber) {
  for (const std::string_view bad : {"nan", "inf", "-inf", "1.0.0", "0x10", "", "1e999", "12abc", "1 2"}) {
    const std::string said = problem("x,y\n1,2\n\n3," + std::string(bad) + "\n");
    EXPECT_NE(said.find("line 4"), std::string::npos) << said;
    EXPECT_NE(said.find("'" + std::string(bad) + "' in column 'y'"), std::string::npos) << said;
  }
}

TEST_F(NumberColumns, RefuseAFileWithoutARow) {
  EXPECT_NE(problem("x,y\n").find("no row"), std::string::npos);
  EXPECT_NE(problem("").find("no column"), std::string::npos);
}

TEST_F(NumberColumns, SayWhichFileIsAbsent) {
  constexpr std::array<std::string_view, 1> kNames = {"x"};
  const auto columns = read_number_columns(folder_.path() / "absent.csv", kNames);
  ASSERT_FALSE(columns.ok());
  EXPECT_NE(columns.error().message().find("absent.csv"), std::string::npos);
}

TEST_F(NumberColumns, OfAFileWithoutNamesAreAllOfThem) {
  std::ofstream(file_, std::ios::binary) << "1,-2\r\n\n3,4e1\n";
  const auto columns = test::must(read_number_rows(file_, 2));
  EXPECT_EQ(columns, (std::vector<std::vector<double>>{{1.0, 3.0}, {-2.0, 40.0}}));
  const auto wrong = read_number_rows(file_, 3);
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().message().find("line 1 has 2 fields where there should be 3"), std::string::npos)
      << wrong.error().message();
  std::ofstream(file_, std::ios::binary) << "\n\n";
  EXPECT_FALSE(read_number_rows(file_, 2).ok());
}

}  // namespace
}  // namespace mstsl::datasets
