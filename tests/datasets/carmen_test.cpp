#include "mstsl/datasets/carmen.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/datasets/corrected_track.hpp"

#include "test_support.hpp"

namespace mstsl::datasets {
namespace {

/// Poses 1 m apart along a line of `length` m and back, a second each.
std::vector<PoseReading> there_and_back(int length_m) {
  std::vector<PoseReading> poses;
  for (int i = 0; i <= 2 * length_m; ++i) {
    const double x_m = i <= length_m ? i : 2 * length_m - i;
    poses.push_back({Stamp::from_seconds(i), Pose2::from({x_m, 0.1 * (i > length_m)}, 0.0)});
  }
  return poses;
}

OccupancyGrid free_hall(double from_x_m, double to_x_m) {
  GridGeometry geometry;
  geometry.resolution_m = 0.1;
  geometry.map_T_grid = {from_x_m, -3.0, 0.0};
  geometry.columns = static_cast<int>(std::lround((to_x_m - from_x_m) / geometry.resolution_m));
  geometry.rows = 60;
  return OccupancyGrid(geometry, CellState::kFree);
}

TEST(Revisits, AreLaterScansOnTheFirstPartsGround) {
  const auto poses = there_and_back(30);
  CarmenOptions options;
  options.mapped_share = 0.5;
  const Revisits revisits = find_revisits(poses, free_hall(-5.0, 40.0), options);
  EXPECT_EQ(revisits.first_later_scan, 31U);
  EXPECT_NEAR(revisits.first_m, 30.0, 0.1);
  EXPECT_NEAR(revisits.later_m, 30.0, 0.1);
  EXPECT_EQ(revisits.within_1m_share, 1.0);
  EXPECT_EQ(revisits.revisiting, 30U);
  EXPECT_EQ(std::count(revisits.follows.begin(), revisits.follows.end(), true), 29);
  EXPECT_FALSE(revisits.follows[31]);  // the first later scan follows one that made the map
}

TEST(Revisits, EndWhereTheMapDoes) {
  const auto poses = there_and_back(30);
  CarmenOptions options;
  options.mapped_share = 0.5;
  const Revisits revisits = find_revisits(poses, free_hall(10.0, 40.0), options);
  for (std::size_t i = 31; i < poses.size(); ++i)
    EXPECT_TRUE(poses[i].map_T_base.x >= 10.0 || !revisits.follows[i]);
  EXPECT_EQ(revisits.revisiting, 20U);
}

TEST(Revisits, KeepAwayFromMappedWalls) {
  const auto poses = there_and_back(30);
  OccupancyGrid map = free_hall(-5.0, 40.0);
  for (int row = 0; row < 60; ++row)
    map[{map.geometry().cell_at({15.0, 0.0}).column, row}] = CellState::kOccupied;
  CarmenOptions options;
  options.mapped_share = 0.5;
  EXPECT_EQ(find_revisits(poses, map, options).revisiting, 29U);
}

TEST(Revisits, KeepNearTheFirstPartsWay) {
  std::vector<PoseReading> poses = there_and_back(30);
  for (std::size_t i = 31; i < poses.size(); ++i) poses[i].map_T_base.y = 2.5;
  CarmenOptions options;
  options.mapped_share = 0.5;
  const Revisits revisits = find_revisits(poses, free_hall(-5.0, 40.0), options);
  EXPECT_EQ(revisits.within_1m_share, 0.0);
  EXPECT_EQ(revisits.revisiting, 0U);
}

TEST(CarmenLogs, WithoutScansAreRefused) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "x.log";
  std::ofstream(file) << "PARAM robot_length 1 nohost 0\nODOM 0 0 0 0 0 0 1.0 nohost 1.0\n";
  const auto dataset = carmen(file, {}, Random(1));
  ASSERT_FALSE(dataset.ok());
  EXPECT_NE(dataset.error().message().find("x.log"), std::string::npos);
}

class RealCarmen : public testing::Test {
 protected:
  static CarmenOptions options() {
    CarmenOptions options;
    options.runs.count = 3;
    options.drive_lanes = false;
    return options;
  }
};

TEST_F(RealCarmen, RunsHoldRecordedScansOfTheLaterPartOnly) {
  MSTSL_REQUIRE_DATA("carmen/intel-corrected.log.gz");
  const auto file = test::data_file("carmen/intel-corrected.log.gz");
  const CarmenLog log = test::must(read_carmen_log(file));
  const Stamp later = log.corrected[first_scan_after(log.corrected, options().mapped_share)].stamp;
  const Dataset dataset = test::must(carmen(file, options(), Random(1)));
  for (const Log& run : dataset.runs) {
    std::size_t scans = 0;
    run.play({[&](const SensorEvent& event) {
                EXPECT_GE(stamp_of(event), later);
                const auto* scan = std::get_if<LaserScan>(&event);
                if (scan == nullptr) return;
                ++scans;
                EXPECT_TRUE(std::any_of(log.scans.begin(), log.scans.end(), [&](const LaserScan& recorded) {
                  return recorded.stamp == scan->stamp && recorded.ranges_m == scan->ranges_m;
                }));
              },
              {}});
    EXPECT_GT(scans, 10U);
  }
}

TEST_F(RealCarmen, RunsHaveOdometryAtEveryScanAndNothingOutOfOrder) {
  MSTSL_REQUIRE_DATA("carmen/intel-corrected.log.gz");
  const Dataset dataset =
      test::must(carmen(test::data_file("carmen/intel-corrected.log.gz"), options(), Random(1)));
  for (const Log& run : dataset.runs) {
    Stamp last{0}, last_odometry{0};
    run.play({[&](const SensorEvent& event) {
                EXPECT_GE(stamp_of(event), last);
                last = stamp_of(event);
                if (std::holds_alternative<OdometryReading>(event)) {
                  EXPECT_GT(last, last_odometry);
                  last_odometry = last;
                }
                EXPECT_TRUE(!std::holds_alternative<LaserScan>(event) || last == last_odometry);
              },
              {}});
  }
}

TEST_F(RealCarmen, RunsKeepToFreeGroundAndTheirLength) {
  MSTSL_REQUIRE_DATA("carmen/intel-corrected.log.gz");
  const Dataset dataset =
      test::must(carmen(test::data_file("carmen/intel-corrected.log.gz"), options(), Random(2)));
  for (const Log& run : dataset.runs) {
    double driven_m = 0.0, longest_gap_s = 0.0, last_field_s = std::numeric_limits<double>::infinity();
    std::vector<PoseReading> truth;
    run.play({[&](const SensorEvent& event) {
                if (!std::holds_alternative<FieldReading>(event)) return;
                const double now_s = stamp_of(event).seconds();
                longest_gap_s = std::max(longest_gap_s, now_s - last_field_s);
                last_field_s = now_s;
              },
              [&](const PoseReading& pose) { truth.push_back(pose); }});
    EXPECT_EQ(state_at(dataset.map, truth.front().map_T_base.position()), CellState::kFree);
    for (std::size_t i = 1; i < truth.size(); ++i) {
      EXPECT_GT(truth[i].stamp, truth[i - 1].stamp);
      driven_m += distance(truth[i - 1].map_T_base, truth[i].map_T_base);
    }
    EXPECT_LE(longest_gap_s, 0.05);  // at least 20 readings a second
    EXPECT_GE(driven_m, 11.9);
    EXPECT_LE(driven_m, 20.0);
  }
}

TEST_F(RealCarmen, FieldIsTheWorldsAtTheTruePlaceWhereverTheRobotFaces) {
  MSTSL_REQUIRE_DATA("carmen/intel-corrected.log.gz");
  CarmenOptions quiet = options();
  quiet.runs.count = 1;
  quiet.robot.magnetometer.noise_uT = quiet.robot.magnetometer.bias_sigma_uT = 0.0;
  const auto file = test::data_file("carmen/intel-corrected.log.gz");
  const auto field_at_start = [&](double yaw_rad) {
    CarmenOptions turned = quiet;
    turned.robot.rig.base_T_magnetometer.linear() =
        Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Dataset dataset = test::must(carmen(file, turned, Random(1)));
    Eigen::Vector3d first_uT = Eigen::Vector3d::Constant(std::nan(""));
    dataset.runs.front().play({[&](const SensorEvent& event) {
                                 const auto* field = std::get_if<FieldReading>(&event);
                                 if (field != nullptr && std::isnan(first_uT.x()))
                                   first_uT = field->sensor_field_uT;
                               },
                               {}});
    return first_uT;
  };
  const Eigen::Vector3d straight_uT = field_at_start(0.0);
  const Eigen::Vector3d turned_uT = Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitZ()) * field_at_start(1.2);
  EXPECT_LT((straight_uT - turned_uT).norm(), 1e-9);
}

TEST_F(RealCarmen, SurveyKeepsToTheFirstPart) {
  MSTSL_REQUIRE_DATA("carmen/intel-corrected.log.gz");
  const auto file = test::data_file("carmen/intel-corrected.log.gz");
  const CarmenLog log = test::must(read_carmen_log(file));
  const Stamp later = log.corrected[first_scan_after(log.corrected, options().mapped_share)].stamp;
  CarmenOptions slow = options();
  slow.robot.magnetometer.rate_hz = 5.0;
  const Dataset dataset = test::must(carmen(file, slow, Random(1)));
  ASSERT_EQ(dataset.surveys.size(), 1U);
  dataset.surveys.front().play({[&](const SensorEvent& event) {
                                  EXPECT_LT(stamp_of(event), later);
                                  EXPECT_FALSE(std::holds_alternative<LaserScan>(event));
                                },
                                [&](const PoseReading& pose) { EXPECT_LT(pose.stamp, later); }});
}

TEST_F(RealCarmen, LogThatHardlyRevisitsSaysHowFewRunsItHas) {
  MSTSL_REQUIRE_DATA("carmen/aces-corrected.log.gz");
  const auto dataset = carmen(test::data_file("carmen/aces-corrected.log.gz"), options(), Random(1));
  ASSERT_FALSE(dataset.ok());
  EXPECT_NE(dataset.error().message().find("stretches are long enough"), std::string::npos);
}

}  // namespace
}  // namespace mstsl::datasets
