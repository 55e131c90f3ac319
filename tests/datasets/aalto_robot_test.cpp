#include "mstsl/datasets/aalto_robot.hpp"

#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "test_support.hpp"

namespace mstsl::datasets {
namespace {

/// Nine drives of three rows, east from (n, 0).
void write_drives(const std::filesystem::path& folder) {
  for (int n = 1; n <= 9; ++n) {
    const std::string start = std::to_string(n);
    std::ofstream(folder / (start + "-loc.csv")) << n << ",0\n" << n << ".1,0\n" << n << ".2,0\n";
    std::ofstream(folder / (start + "-mag.csv")) << "1,2,-40\n1.5,2,-40\n2,2," << n << "\n";
    std::ofstream(folder / (start + "-time.csv")) << "19.71\n19.73\n19.75\n";
  }
}

TEST(AaltoRobot, FourDrivesAreSurveysAndFiveAreChecks) {
  const test::TemporaryFolder folder;
  write_drives(folder.path());
  const Dataset dataset = test::must(aalto_robot(folder.path()));
  ASSERT_EQ(dataset.surveys.size(), 4U);
  ASSERT_EQ(dataset.checks.size(), 5U);
  EXPECT_TRUE(dataset.runs.empty());
  std::vector<PoseReading> poses;
  std::vector<FieldReading> readings;
  dataset.checks.front().play({[&](const SensorEvent& e) { readings.push_back(std::get<FieldReading>(e)); },
                               [&](const PoseReading& pose) { poses.push_back(pose); }});
  ASSERT_EQ(poses.size(), 3U);
  ASSERT_EQ(readings.size(), 3U);
  EXPECT_EQ(poses[2].map_T_base.position(), Eigen::Vector2d(5.2, 0));
  EXPECT_EQ(readings[2].sensor_field_uT, Eigen::Vector3d(2, 2, 5));
  EXPECT_NEAR(readings[2].stamp - readings[0].stamp, 0.04, 1e-9);
  EXPECT_EQ(state_at(dataset.map, {5.1, 0.0}), CellState::kFree);
}

TEST(AaltoRobot, DriveWithAFileCutOffIsRefused) {
  const test::TemporaryFolder folder;
  write_drives(folder.path());
  std::ofstream(folder.path() / "3-mag.csv") << "1,2,-40\n";
  const auto dataset = aalto_robot(folder.path());
  ASSERT_FALSE(dataset.ok());
  EXPECT_NE(dataset.error().message().find("drive 3 has 3 positions, 1 readings and 3 times"),
            std::string::npos)
      << dataset.error().message();
}

TEST(AaltoRobot, RealDrivesAreReadWhole) {
  MSTSL_REQUIRE_DATA("aalto-robot/9-time.csv");
  const Dataset dataset = test::must(aalto_robot(test::data_file("aalto-robot")));
  std::size_t readings = 0;
  for (const Log& survey : dataset.surveys) survey.play({[&](const SensorEvent&) { ++readings; }, {}});
  EXPECT_EQ(readings, 8875U + 9105U + 9404U + 7332U);
}

}  // namespace
}  // namespace mstsl::datasets
