// What becomes of a log's messages, one by one: used, sorted, converted, or dropped and counted.
#include <cmath>

#include "mstsl/io/recording_info.hpp"

#include "play_fixture.hpp"

namespace mstsl::test {
namespace {

TEST_F(Play, UnwantedTopicsAreNotDecoded) {
  {
    UsualLog log(path());
    log.begin();
    log.write_bytes("/imu/data", io::as_bytes("rubbish"), 100.0);
    log.close();
  }
  io::PlayOptions options;
  options.topics.imu = "";
  const Played played = play_all({path()}, options);
  EXPECT_TRUE(played.report.problems.empty());
  EXPECT_EQ(played.report.messages.count("/imu/data"), 0U);
  EXPECT_EQ(problems(play_all({path()}).report, "messages that are cut short"), 1U);
}

TEST_F(Play, DropsAndCountsUnusableMessages) {
  {
    UsualLog log(path());
    log.begin();
    log.put(ros_odometry(101.0, kNan), 101.0);
    log.put(ros_odometry(101.1, std::numeric_limits<double>::infinity()), 101.1);
    auto odometry = ros_odometry(101.2);
    odometry.pose.pose.orientation = {0.0, 0.0, 0.0, 0.0};
    log.put(odometry, 101.2);
    odometry.pose.pose.orientation = {0.0, 0.0, 0.7, 0.7};  // 1 % short: rounded, not wrong
    odometry.header = ros_header(101.3, "odom");
    log.put(odometry, 101.3);
    log.put(ros_field(101.4, kNan), 101.4);
    log.put(ros_field(101.5, 40e-6, "other_imu"), 101.5);
    log.put(ros_scan(101.6, 0), 101.6);
    auto scan = ros_scan(101.7);
    scan.angle_increment = static_cast<float>(kNan);
    log.put(scan, 101.7);
    log.close();
  }
  const Played played = play_all({path()});
  EXPECT_EQ(problems(played.report, "odometry readings that are not finite"), 2U);
  EXPECT_EQ(problems(played.report, "quaternion"), 1U);
  EXPECT_EQ(problems(played.report, "magnetic readings that are not finite"), 1U);
  EXPECT_EQ(problems(played.report, "magnetic readings of another frame"), 1U);
  EXPECT_EQ(problems(played.report, "scans without beams"), 1U);
  EXPECT_EQ(problems(played.report, "scans with impossible angles"), 1U);
  EXPECT_EQ(played.events.size(), 4U);
  EXPECT_NEAR(played.of<OdometryReading>().back().odom_T_base.yaw, 0.5 * kPi, 1e-9);
}

TEST_F(Play, KeepsScansThatTurnClockwiseAndBeamsWithoutReturn) {
  {
    UsualLog log(path());
    log.begin();
    auto scan = ros_scan(101.0, 3);
    scan.angle_increment = -0.25F;
    scan.ranges = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(), 1.0F};
    log.put(scan, 101.0);
    log.close();
  }
  const LaserScan scan = play_all({path()}).of<LaserScan>().back();
  EXPECT_EQ(scan.angle_increment_rad, -0.25);
  ASSERT_EQ(scan.ranges_m.size(), 3U);
  EXPECT_TRUE(std::isinf(scan.ranges_m[0]));
}

TEST_F(Play, DropsASecondMessageWithTheSameStamp) {
  {
    UsualLog log(path());
    log.begin();
    log.put(ros_odometry(101.0, 0.1), 101.0);
    log.put(ros_odometry(101.0, 0.2), 101.01);
    log.put(ros_field(101.0), 101.0);
    log.close();
  }
  const Played played = play_all({path()});
  EXPECT_EQ(problems(played.report, "stamp of the one before"), 1U);
  EXPECT_EQ(played.of<OdometryReading>().back().odom_T_base.x, 0.1);
  EXPECT_EQ(played.of<FieldReading>().size(), 2U);
}

TEST_F(Play, TakesTheTimeOfRecordingWhereThereIsNoStamp) {
  {
    UsualLog log(path());
    log.begin();
    log.put(ros_odometry(0.0), 101.5);
    log.close();
  }
  const Played played = play_all({path()});
  EXPECT_EQ(problems(played.report, "without a stamp"), 1U);
  EXPECT_EQ(played.of<OdometryReading>().back().stamp, Stamp::from_seconds(101.5));
}

TEST_F(Play, SortsByStampWithinTheWindowAndCountsWhatIsLate) {
  {
    UsualLog log(path());
    log.begin();
    for (const double stamp : {101.2, 101.0, 101.4, 102.5, 102.3, 104.0, 101.5, 105.0})
      log.put(ros_odometry(stamp), std::max(stamp, 104.0));
    log.close();
  }
  const Played played = play_all({path()});
  std::vector<std::int64_t> stamps;
  for (const auto& reading : played.of<OdometryReading>()) stamps.push_back(reading.stamp.ns);
  EXPECT_EQ(stamps, nanoseconds({100.0, 101.0, 101.2, 101.4, 102.3, 102.5, 104.0, 105.0}));
  EXPECT_EQ(problems(played.report, "late"), 1U);
}

TEST_F(Play, TakesAnImpossibleJumpOfTheOdometryAsARestart) {
  {
    UsualLog log(path());
    log.begin();
    log.put(ros_odometry(100.1, 0.1), 100.1);
    log.put(ros_odometry(100.2, 35.0), 100.2);
    log.put(ros_odometry(100.3, 35.1), 100.3);
    log.put(ros_odometry(109.0, 45.0), 109.0);  // ten metres in nine seconds: driven
    log.close();
  }
  const Played played = play_all({path()});
  ASSERT_EQ(played.of<OdometryRestart>().size(), 1U);
  EXPECT_EQ(played.of<OdometryRestart>()[0].stamp, Stamp::from_seconds(100.2));
  EXPECT_EQ(problems(played.report, "taken as restarts"), 1U);
}

TEST_F(Play, SaysWhichSensorCouldNotBeUsedAtAll) {
  {
    UsualLog log(path());
    log.begin();
    for (int i = 1; i < 50; ++i) {
      log.put(ros_odometry(100.0 + 0.1 * i), 100.0 + 0.1 * i);
      // Its driver's clock is an hour ahead of the robot's.
      auto imu = io::ros::Imu{};
      imu.header = ros_header(3700.0 + 0.1 * i, "imu_link");
      log.write("/imu/data", imu, 100.0 + 0.1 * i);
    }
    log.close();
  }
  const Played played = play_all({path()});
  EXPECT_TRUE(warns_of(played.report, "none of the 49 messages on /imu/data could be used"));
  EXPECT_EQ(problems(played.report, "stamps far in the future"), 49U);
  EXPECT_EQ(played.of<OdometryReading>().size(), 50U);
}

struct Unit {
  double strength;
  const char* name;
};

class PlayInUnit : public Play, public testing::WithParamInterface<Unit> {};

TEST_P(PlayInUnit, GivesMicroteslaAndSaysWhatWasAssumed) {
  {
    UsualLog log(path());
    log.begin();
    log.close();
  }
  {
    UsualLog log(path());
    io::ros::TFMessage mountings;
    mountings.transforms = {ros_transform("base_link", "laser", {}),
                            ros_transform("base_link", "imu_link", {})};
    log.write("/tf_static", mountings, 100.0);
    log.put(ros_odometry(100.0), 100.0);
    log.put(ros_scan(100.0), 100.0);
    for (int i = 0; i < 60; ++i) log.put(ros_field(100.0 + 0.01 * i, GetParam().strength), 100.0 + 0.01 * i);
    log.close();
  }
  const Played played = play_all({path()});
  EXPECT_NEAR(played.of<FieldReading>().front().sensor_field_uT.x(), 50.0, 1e-9);
  ASSERT_EQ(played.report.warnings.size(), 1U);
  EXPECT_TRUE(warns_of(played.report, std::string("taken to be ") + GetParam().name));
}

INSTANTIATE_TEST_SUITE_P(Units, PlayInUnit,
                         testing::Values(Unit{50.0, "microtesla"}, Unit{50e3, "nanotesla"},
                                         Unit{0.5, "gauss"}, Unit{500.0, "milligauss"},
                                         Unit{1.0, "normalised"}),
                         [](const auto& unit) { return std::string(unit.param.name); });

TEST_F(Play, RefusesAFieldThatFitsNoUnit) {
  {
    UsualLog log(path());
    log.put(ros_odometry(1.0), 1.0);
    log.put(ros_scan(1.0), 1.0);
    log.put(ros_field(1.0, 7.0), 1.0);
    log.close();
  }
  EXPECT_NE(error().find("topic /imu/mag: the magnetic readings have a median strength of 7"),
            std::string::npos)
      << error();
}

}  // namespace
}  // namespace mstsl::test
