#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "mstsl/localize/two_step.hpp"

#include "../../localize/hand_made_world.hpp"
#include "../recording_support.hpp"
#include "reference_drive.hpp"

namespace mstsl::test {
namespace {

const std::filesystem::path kFolder = MSTSL_INTEROP_DIR;

/// Values that pass through unchanged are compared for equality, computed ones within rounding.
void expect_reference_drive(const Played& played) {
  EXPECT_TRUE(played.rig.base_T_laser.isApprox(reference_rig().base_T_laser, 1e-12));
  EXPECT_TRUE(played.rig.base_T_magnetometer.isApprox(reference_rig().base_T_magnetometer, 1e-12));
  EXPECT_TRUE(played.report.problems.empty());
  EXPECT_TRUE(played.report.warnings.empty()) << played.report.warnings.front();

  const auto odometry = played.of<OdometryReading>();
  const auto field = played.of<FieldReading>();
  const auto imu = played.of<ImuReading>();
  const auto poses = played.of<PoseReading>();
  const auto scans = played.of<LaserScan>();
  ASSERT_EQ(odometry.size(), kSteps);
  ASSERT_EQ(field.size(), kSteps);
  ASSERT_EQ(imu.size(), kSteps);
  ASSERT_EQ(poses.size(), kSteps);
  ASSERT_EQ(scans.size(), kSteps);
  const std::vector<SensorEvent> expected = reference_events();
  for (std::size_t i = 0; i < kSteps; ++i) {
    const Stamp stamp = reference_stamp(static_cast<int>(i));
    const auto& wanted_odometry = std::get<OdometryReading>(expected[5 * i]);
    EXPECT_EQ(odometry[i].stamp, stamp);
    EXPECT_EQ(odometry[i].odom_T_base.position(), wanted_odometry.odom_T_base.position());
    EXPECT_NEAR(odometry[i].odom_T_base.yaw, kYaw_rad, 1e-12);
    EXPECT_EQ(field[i].stamp, stamp);
    const auto& wanted_field = std::get<FieldReading>(expected[5 * i + 1]);
    EXPECT_NEAR((field[i].sensor_field_uT - wanted_field.sensor_field_uT).norm(), 0.0, 1e-12);
    const auto& wanted_imu = std::get<ImuReading>(expected[5 * i + 2]);
    EXPECT_EQ(imu[i].stamp, stamp);
    EXPECT_EQ(imu[i].angular_velocity_rad_s, wanted_imu.angular_velocity_rad_s);
    ASSERT_TRUE(imu[i].world_q_sensor.has_value());
    EXPECT_TRUE(imu[i].world_q_sensor->isApprox(*wanted_imu.world_q_sensor, 1e-12));
    const auto& wanted_pose = std::get<PoseReading>(expected[5 * i + 3]);
    EXPECT_EQ(poses[i].stamp, stamp);
    EXPECT_EQ(poses[i].map_T_base.position(), wanted_pose.map_T_base.position());
    EXPECT_EQ(poses[i].map_T_base.yaw, 0.0);
    const auto& wanted_scan = std::get<LaserScan>(expected[5 * i + 4]);
    EXPECT_EQ(scans[i].stamp, stamp);
    EXPECT_EQ(scans[i].angle_min_rad, wanted_scan.angle_min_rad);
    EXPECT_EQ(scans[i].angle_increment_rad, wanted_scan.angle_increment_rad);
    EXPECT_EQ(scans[i].time_increment_s, wanted_scan.time_increment_s);
    EXPECT_EQ(scans[i].range_min_m, wanted_scan.range_min_m);
    EXPECT_EQ(scans[i].range_max_m, wanted_scan.range_max_m);
    EXPECT_EQ(scans[i].ranges_m, wanted_scan.ranges_m);
  }
}

class OtherPeoplesLogs : public testing::TestWithParam<const char*> {};

TEST_P(OtherPeoplesLogs, ArePlayedWithTheirExactValues) {
  const std::filesystem::path file = kFolder / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " was not written; see the test that writes it";
  io::PlayOptions options;
  options.topics = reference_topics();
  expect_reference_drive(play_all({file}, options));
}

std::string name_of(const testing::TestParamInfo<const char*>& file) {
  std::string name = file.param;
  std::ranges::replace(name, '.', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(ByRosbag, OtherPeoplesLogs, testing::Values("none.bag", "lz4.bag", "bz2.bag"),
                         name_of);
INSTANTIATE_TEST_SUITE_P(ByNpm, OtherPeoplesLogs,
                         testing::Values("none.mcap", "flat.mcap", "unindexed.mcap", "lz4.mcap", "zstd.mcap"),
                         name_of);

std::vector<SensorEvent> drive_to_localize(const HandMadeWorld& world) {
  return events_of(world, {{3.0, 1.0, radians(30)}, radians(-30), 0.0, 6.0}, Rig{});
}

std::string line_of(const SensorEvent& event) {
  const Stamp stamp = stamp_of(event);
  std::string values;
  if (const auto* odometry = std::get_if<OdometryReading>(&event)) {
    const Pose2& pose = odometry->odom_T_base;
    values = fmt::format(R"("odometry",{},{},{},{},{})", stamp.ns / 1'000'000'000, stamp.ns % 1'000'000'000,
                         pose.x, pose.y, pose.yaw);
  } else if (const auto* field = std::get_if<FieldReading>(&event)) {
    const Eigen::Vector3d& b = field->sensor_field_uT;
    values = fmt::format(R"("field",{},{},{},{},{})", stamp.ns / 1'000'000'000, stamp.ns % 1'000'000'000,
                         b.x(), b.y(), b.z());
  } else if (const auto* scan = std::get_if<LaserScan>(&event)) {
    std::vector<float> ranges_m = scan->ranges_m;  // JSON has no infinity; beyond the limit is no return, too
    for (float& range_m : ranges_m)
      if (!std::isfinite(range_m)) range_m = 1e3F;
    values = fmt::format(R"("scan",{},{},{},{},{},{},[{}])", stamp.ns / 1'000'000'000,
                         stamp.ns % 1'000'000'000, scan->angle_min_rad, scan->angle_increment_rad,
                         scan->range_min_m, scan->range_max_m, fmt::join(ranges_m, ","));
  }
  return "[" + values + "]\n";
}

TEST(OurDrive, IsDumpedForOthersToWriteAsLogs) {
  std::filesystem::create_directories(kFolder);
  std::ofstream file(kFolder / "run.jsonl");
  for (const SensorEvent& event : drive_to_localize(HandMadeWorld())) file << line_of(event);
  ASSERT_TRUE(file.flush());
}

Estimate localized(const HandMadeWorld& world, const std::vector<SensorEvent>& events) {
  TwoStep localizer(world.maps, Rig{});
  for (const SensorEvent& event : events) feed(localizer, event);
  return localizer.estimate();
}

class OtherPeoplesRuns : public testing::TestWithParam<const char*> {};

TEST_P(OtherPeoplesRuns, AreLocalizedAsTheSameEventsAre) {
  const std::filesystem::path file = kFolder / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " was not written; see the test that writes it";
  const HandMadeWorld world;
  const Estimate expected = localized(world, drive_to_localize(world));
  const Estimate found = localized(world, play_all({file}).events);
  ASSERT_TRUE(expected.map_T_base);
  ASSERT_TRUE(found.map_T_base);
  EXPECT_LT(distance(*found.map_T_base, *expected.map_T_base), 1e-4);  // ROS messages hold angles as floats
  EXPECT_NEAR(found.probability, expected.probability, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(By, OtherPeoplesRuns, testing::Values("run.bag", "run.mcap"), name_of);

TEST(OurLog, IsWrittenForOthersToRead) {
  std::filesystem::create_directories(kFolder);
  write_log(kFolder / "ours.mcap", reference_events(), reference_topics(), reference_rig());
  io::PlayOptions options;
  options.topics = reference_topics();
  expect_reference_drive(play_all({kFolder / "ours.mcap"}, options));
}

}  // namespace
}  // namespace mstsl::test
