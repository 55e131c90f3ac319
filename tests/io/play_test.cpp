// Logs as a whole: files, topics, and where the sensors sit.
#include "mstsl/core/angles.hpp"
#include "mstsl/io/recording_info.hpp"

#include "play_fixture.hpp"

namespace mstsl::test {
namespace {

TEST_F(Play, PutsARestartBetweenFiles) {
  Random random(1);
  const auto first = random_drive(random, 3.0);
  const auto second = random_drive(random, 2.0, 31, 1'700'001'000.0);
  write_log(path("a.mcap"), first);
  write_log(path("b.mcap"), second);
  const Played played = play_all({path("a.mcap"), path("b.mcap")});
  EXPECT_EQ(played.headers, 1);
  const auto restarts = played.of<OdometryRestart>();
  ASSERT_EQ(restarts.size(), 1U);
  EXPECT_EQ(restarts[0].stamp, stamp_of(second.front()));
  EXPECT_EQ(played.of<OdometryReading>().size(), 150U + 100U);
  EXPECT_TRUE(played.report.warnings.empty());
  EXPECT_EQ(played.report.messages.at("/odom"), 250U);
}

TEST_F(Play, SaysWhenFilesAreNotInTheOrderOfTheirTimes) {
  Random random(1);
  write_log(path("a.mcap"), random_drive(random, 2.0, 31, 2000.0));
  write_log(path("b.mcap"), random_drive(random, 2.0, 31, 1000.0));
  const Played played = play_all({path("a.mcap"), path("b.mcap")});
  EXPECT_TRUE(warns_of(played.report, "b.mcap: begins before the end"));
  EXPECT_EQ(played.of<OdometryReading>().size(), 200U);
}

TEST_F(Play, SaysWhenTheSensorsMovedBetweenFiles) {
  Random random(1);
  write_log(path("a.mcap"), random_drive(random, 2.0, 31, 1000.0));
  write_log(path("b.mcap"), random_drive(random, 2.0, 31, 2000.0), {}, Rig{});
  EXPECT_TRUE(warns_of(play_all({path("a.mcap"), path("b.mcap")}).report, "sit elsewhere"));
}

TEST_F(Play, StopsWhenTheReceiverHasEnough) {
  Random random(1);
  write_log(path(), random_drive(random, 10.0));
  int count = 0;
  must(io::play({path(), path()}, {}, {}, [&count](const SensorEvent&) { return ++count < 7; }));
  EXPECT_EQ(count, 7);
}

TEST_F(Play, ListsWhatIsThereWhenATopicIsMissing) {
  Random random(1);
  write_log(path(), random_drive(random, 1.0));
  io::PlayOptions options;
  options.topics.scan = "/front/scan";
  const std::string message = error(options);
  for (const char* words :
       {"log.mcap", "there is no topic /front/scan", "/scan (sensor_msgs/LaserScan, 10 messages)",
        "/odom (nav_msgs/Odometry, 50 messages)"})
    EXPECT_NE(message.find(words), std::string::npos) << message;
}

TEST_F(Play, RefusesATopicOfAnotherType) {
  Random random(1);
  write_log(path(), random_drive(random, 1.0));
  io::PlayOptions options;
  options.topics.scan = "/odom";
  options.topics.odometry = "/scan";
  EXPECT_NE(error(options).find("carries nav_msgs/Odometry"), std::string::npos) << error(options);
}

TEST_F(Play, RefusesOneTopicInTwoRoles) {
  Random random(1);
  write_log(path(), random_drive(random, 1.0));
  io::PlayOptions options;
  options.topics.pose = "/odom";
  EXPECT_NE(error(options).find("/odom is named as the odometry topic and as the pose topic"),
            std::string::npos);
}

TEST_F(Play, RefusesATopicWithoutMessagesAndALogWithoutAny) {
  {
    UsualLog log(path());
    log.put(ros_odometry(1.0), 1.0);
    log.close();
  }
  EXPECT_NE(error().find("/scan holds no message"), std::string::npos) << error();
  {
    UsualLog log(path());
    log.close();
  }
  EXPECT_NE(error().find("holds no messages"), std::string::npos) << error();
}

TEST_F(Play, NamesFilesThatCannotBeRead) {
  EXPECT_NE(error().find("log.mcap: cannot be opened"), std::string::npos) << error();
  write_bytes(path(), "");
  EXPECT_NE(error().find("log.mcap: the file is empty"), std::string::npos) << error();
  write_bytes(path(), "x,y,theta\n1,2,3\n");
  EXPECT_NE(error().find("log.mcap: is no log that can be read"), std::string::npos) << error();
  EXPECT_FALSE(io::play({}, {}, {}, [](const SensorEvent&) { return true; }).ok());
}

TEST_F(Play, RefusesAWindowThatMakesNoSense) {
  io::PlayOptions options;
  for (const double window_s : {-1.0, kNan, 1e6}) {
    options.reorder_window_s = window_s;
    EXPECT_NE(error(options).find("reorder window"), std::string::npos);
  }
}

TEST_F(Play, FindsMountingsThroughTheChainOfFramesWhereverTheyStandInTheLog) {
  const io::ros::Quaternion quarter{0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)};
  {
    UsualLog log(path());
    log.put(ros_odometry(1.0), 1.0);
    log.put(ros_scan(1.0, 10, "/laser"), 1.0);
    log.put(ros_field(1.0), 1.0);
    io::ros::TFMessage first;
    first.transforms = {ros_transform("/base_link", "/mast", {1.0, 0.0, 0.5}, quarter)};
    io::ros::TFMessage second;
    second.transforms = {ros_transform("mast", "laser", {0.25, 0.0, 0.0}),
                         ros_transform("imu_link", "mast", {0.0, 0.0, 1.0}, quarter)};
    log.write("/tf_static", first, 2.0);
    log.write("/tf_static", second, 3.0);
    log.close();
  }
  const Played played = play_all({path()});
  EXPECT_TRUE(played.report.warnings.empty());
  const Eigen::AngleAxisd turn(0.5 * kPi, Eigen::Vector3d::UnitZ());
  const Eigen::Isometry3d base_T_mast = Eigen::Translation3d(1.0, 0.0, 0.5) * turn;
  EXPECT_TRUE(played.rig.base_T_laser.isApprox(base_T_mast * Eigen::Translation3d(0.25, 0.0, 0.0), 1e-9));
  EXPECT_TRUE(played.rig.base_T_magnetometer.isApprox(
      base_T_mast * (Eigen::Translation3d(0.0, 0.0, 1.0) * turn).inverse(), 1e-9));
}

TEST_F(Play, SaysLoudlyWhichMountingIsMissing) {
  {
    UsualLog log(path());
    io::ros::TFMessage mountings;
    mountings.transforms = {ros_transform("base_footprint", "laser", {1.0, 0.0, 0.0})};
    log.write("/tf_static", mountings, 1.0);
    log.put(ros_odometry(1.0), 1.0);
    log.put(ros_scan(1.0), 1.0);
    log.put(ros_field(1.0), 1.0);
    log.close();
  }
  const Played played = play_all({path()});
  EXPECT_EQ(played.report.warnings.size(), 2U);
  EXPECT_TRUE(
      warns_of(played.report, "no way from 'base_link' to 'laser' (frames there: base_footprint, laser)"));
  EXPECT_TRUE(warns_of(played.report, "no way from 'base_link' to 'imu_link'"));
  io::PlayOptions options;
  options.base_frame = "/base_footprint";
  const Played right = play_all({path()}, options);
  EXPECT_EQ(right.report.warnings.size(), 1U);
  EXPECT_NEAR(right.rig.base_T_laser.translation().x(), 1.0, 1e-12);
}

TEST_F(Play, TurnsInertialReadingsIntoTheMagnetometersFrame) {
  {
    UsualLog log(path());
    io::ros::TFMessage mountings;
    mountings.transforms = {
        ros_transform("base_link", "laser", {}), ros_transform("base_link", "imu_link", {}),
        ros_transform("imu_link", "gyro", {}, {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)})};
    log.write("/tf_static", mountings, 1.0);
    log.put(ros_odometry(1.0), 1.0);
    log.put(ros_scan(1.0), 1.0);
    log.put(ros_field(1.0), 1.0);
    io::ros::Imu imu;
    imu.header = ros_header(1.0, "gyro");
    imu.angular_velocity = {1.0, 0.0, 0.25};
    log.write("/imu/data", imu, 1.0);
    log.close();
  }
  const auto readings = play_all({path()}).of<ImuReading>();
  ASSERT_EQ(readings.size(), 1U);
  EXPECT_TRUE(readings[0].angular_velocity_rad_s.isApprox(Eigen::Vector3d(0.0, 1.0, 0.25), 1e-9));
  // The gyro's x axis points along the magnetometer's y; its world attitude is the identity.
  ASSERT_TRUE(readings[0].world_q_sensor.has_value());
  EXPECT_TRUE(
      (*readings[0].world_q_sensor * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
}

TEST_F(Play, DescribesALogWithoutPlayingIt) {
  Random random(1);
  write_log(path(), random_drive(random, 2.0, 31, 1000.0), survey_topics());
  const io::RecordingInfo info = must(io::describe_recording(path()));
  EXPECT_EQ(info.format, "MCAP");
  ASSERT_EQ(info.topics.size(), 6U);
  EXPECT_EQ(info.topics[0].name, "/ground_truth");
  EXPECT_EQ(info.topics[0].type, "geometry_msgs/PoseStamped");
  EXPECT_EQ(info.topics[0].messages, 50U);
  EXPECT_EQ(info.first, Stamp::from_seconds(1000.0));
  EXPECT_TRUE(io::is_recording(path()));
  EXPECT_FALSE(io::describe_recording(path("absent.mcap")).ok());
  EXPECT_FALSE(io::is_recording(path("absent.mcap")));
}

}  // namespace
}  // namespace mstsl::test
