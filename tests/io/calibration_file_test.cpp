#include "mstsl/io/calibration_file.hpp"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "test_support.hpp"

namespace mstsl::io {
namespace {

std::string problem_with(const std::string& text) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "c.yaml") << text;
  const auto read = read_calibration(folder.path() / "c.yaml");
  return read ? "none" : read.error().message();
}

TEST(CalibrationFile, IsReadBackAsWritten) {
  const test::TemporaryFolder folder;
  TurnCalibration found;
  found.calibration.hard_iron_uT = {12.25, -7.5, 0.125};
  found.calibration.soft_iron << 1.0625, 0.03125, 0, 0.03125, 0.9375, 0, -0.015625, 0.0078125, 1;
  found.turns = 3;
  test::must(write_calibration(found, folder.path() / "c.yaml"));
  const auto read = test::must(read_calibration(folder.path() / "c.yaml"));
  EXPECT_EQ(read.hard_iron_uT, found.calibration.hard_iron_uT);
  EXPECT_EQ(read.soft_iron, found.calibration.soft_iron);
}

TEST(CalibrationFile, WhatIsWrongIsSaidInOneSentence) {
  const std::string good = "hard_iron_uT: [1, 2, 3]\nsoft_iron: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n";
  EXPECT_EQ(problem_with(good), "none");
  const auto expect = [](const std::string& text, const std::string& words) {
    EXPECT_NE(problem_with(text).find(words), std::string::npos) << problem_with(text);
  };
  expect("", "no keys");
  expect("[1, 2]", "no keys");
  expect("hard_iron_uT: [1, 2, 3]\n", "'soft_iron' is missing");
  expect("hard_iron_uT: [1, 2]\nsoft_iron: 3\n", "'hard_iron_uT' (line 1)");
  expect("hard_iron_uT: [1, .nan, 3]\n", "not a finite number");
  expect("hard_iron_uT: [1, two, 3]\n", "not a number");
  expect("hard_iron_uT: [1, 2, 3]\nsoft_iron: [[1, 0, 0], [0, 1], [0, 0, 1]]\n", "'soft_iron' (line 2)");
  expect("hard_iron_uT: [1, 2, 3]\nsoft_iron: [[1, 0, 0], [0, -1, 0], [0, 0, 1]]\n", "mirrors");
  expect("hard_iron_uT: [1, 2, 3]\nsoft_iron: [[50, 0, 0], [0, 50, 0], [0, 0, 50]]\n", "scales by 50");
  expect("hard_iron_uT: [1, 2\n\x01", "is not yaml");
  EXPECT_NE(read_calibration("/nowhere/c.yaml").error().message().find("/nowhere/c.yaml"), std::string::npos);
}

}  // namespace
}  // namespace mstsl::io
