#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"

#include "recording_support.hpp"

namespace mstsl::test {
namespace {

void expect_same(const Pose2& a, const Pose2& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(angle_between(a.yaw, b.yaw), 0.0, 1e-12);
}

void expect_same(const OdometryReading& a, const OdometryReading& b) {
  expect_same(a.odom_T_base, b.odom_T_base);
}
void expect_same(const PoseReading& a, const PoseReading& b) { expect_same(a.map_T_base, b.map_T_base); }
void expect_same(const OdometryRestart&, const OdometryRestart&) {}

void expect_same(const FieldReading& a, const FieldReading& b) {
  EXPECT_NEAR((a.sensor_field_uT - b.sensor_field_uT).norm(), 0.0, 1e-11);
}

void expect_same(const ImuReading& a, const ImuReading& b) {
  EXPECT_NEAR((a.angular_velocity_rad_s - b.angular_velocity_rad_s).norm(), 0.0, 1e-12);
  ASSERT_EQ(a.world_q_sensor.has_value(), b.world_q_sensor.has_value());
  if (!a.world_q_sensor) return;
  EXPECT_NEAR(a.world_q_sensor->angularDistance(*b.world_q_sensor), 0.0, 1e-7);
}

/// ROS keeps the angles of a scan in 32 bits.
void expect_same(const LaserScan& a, const LaserScan& b) {
  EXPECT_EQ(a.ranges_m, b.ranges_m);
  EXPECT_FLOAT_EQ(static_cast<float>(a.angle_min_rad), static_cast<float>(b.angle_min_rad));
  EXPECT_FLOAT_EQ(static_cast<float>(a.angle_increment_rad), static_cast<float>(b.angle_increment_rad));
  EXPECT_FLOAT_EQ(static_cast<float>(a.range_min_m), static_cast<float>(b.range_min_m));
  EXPECT_FLOAT_EQ(static_cast<float>(a.range_max_m), static_cast<float>(b.range_max_m));
}

void expect_same(const std::vector<SensorEvent>& written, const std::vector<SensorEvent>& read) {
  ASSERT_EQ(written.size(), read.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    ASSERT_EQ(written[i].index(), read[i].index()) << "event " << i;
    ASSERT_EQ(stamp_of(written[i]), stamp_of(read[i])) << "event " << i;
    std::visit(
        [&](const auto& event) { expect_same(event, std::get<std::decay_t<decltype(event)>>(read[i])); },
        written[i]);
  }
}

class RoundTrip : public testing::TestWithParam<int> {};

TEST_P(RoundTrip, WhatIsWrittenIsWhatIsPlayed) {
  Random random(static_cast<std::uint64_t>(GetParam()));
  const std::vector<SensorEvent> written =
      random_drive(random, random.uniform(1.0, 60.0), random.index(400) + 1);
  const TemporaryFolder folder;
  const auto file = folder.path() / "log.mcap";
  write_log(file, written, survey_topics());

  io::PlayOptions options;
  options.topics = survey_topics();
  const Played played = play_all({file}, options);
  expect_same(written, played.events);
  EXPECT_TRUE(played.rig.base_T_laser.isApprox(tilted_rig().base_T_laser, 1e-12));
  EXPECT_TRUE(played.rig.base_T_magnetometer.isApprox(tilted_rig().base_T_magnetometer, 1e-12));
  EXPECT_TRUE(played.report.problems.empty());
  EXPECT_TRUE(played.report.warnings.empty());
}

INSTANTIATE_TEST_SUITE_P(RandomDrives, RoundTrip, testing::Range(1, 9));

TEST(RecordingWriter, LeavesNothingWhenItIsDropped) {
  const TemporaryFolder folder;
  {
    auto writer = must(io::RecordingWriter::open(folder.path() / "log.mcap", Rig{}, io::Topics{}));
    must(writer.write(OdometryReading{{1}, {}}));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(RecordingWriter, RefusesStampsThatRosCannotHold) {
  const TemporaryFolder folder;
  auto writer = must(io::RecordingWriter::open(folder.path() / "log.mcap", Rig{}, io::Topics{}));
  EXPECT_FALSE(writer.write(OdometryReading{{-1}, {}}).ok());
  EXPECT_FALSE(writer.write(OdometryReading{Stamp::from_seconds(3e9), {}}).ok());
}

TEST(RecordingWriter, RefusesARestartInTheMiddle) {
  const TemporaryFolder folder;
  auto writer = must(io::RecordingWriter::open(folder.path() / "log.mcap", Rig{}, io::Topics{}));
  EXPECT_TRUE(writer.write(OdometryRestart{{1}}).ok());
  must(writer.write(OdometryReading{{2}, {}}));
  EXPECT_FALSE(writer.write(OdometryRestart{{3}}).ok());
}

TEST(RecordingWriter, SaysWhichFileCannotBeWritten) {
  const auto opened = io::RecordingWriter::open("/nonexistent/folder/log.mcap", Rig{}, io::Topics{});
  ASSERT_FALSE(opened.ok());
  EXPECT_NE(opened.error().message().find("/nonexistent/folder/log.mcap"), std::string::npos);
}

}  // namespace
}  // namespace mstsl::test
