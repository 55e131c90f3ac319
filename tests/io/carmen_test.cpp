#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/io/recording_info.hpp"

#include "io/carmen/odometry.hpp"
#include "io/carmen/parse.hpp"
#include "recording_support.hpp"

namespace mstsl::test {
namespace {

using namespace io::carmen;

io::PlayOptions with_poses() {
  io::PlayOptions options;
  options.topics.pose = "corrected";
  return options;
}

std::string odometry_line(const Pose2& pose, double time_s) {
  return fmt::format("ODOM {:.17g} {:.17g} {:.17g} 0 0 0 {} host {}\n", pose.x, pose.y, pose.yaw, time_s,
                     time_s);
}

std::string scan_line(const Pose2& pose, double time_s, int beams = 180) {
  std::string line = fmt::format("FLASER {}", beams);
  for (int i = 0; i < beams; ++i) line += fmt::format(" {}", 1.0 + 0.01 * i);
  const std::string text = fmt::format(" {:.17g} {:.17g} {:.17g}", pose.x, pose.y, pose.yaw);
  return line + text + text + fmt::format(" {} host {}\n", time_s, time_s);
}

/// A drive whose wheels are known, and the log that its authors made by correcting the pose at each scan.
struct CorrectedDrive {
  std::string log = "PARAM robot_frontlaser_offset 0.0\n";
  std::vector<Pose2> wheel_poses;  ///< one for each ODOM line that is no new start
  std::vector<Pose2> corrected;

  explicit CorrectedDrive(Random& random) {
    Pose2 wheels;
    Pose2 in_line_frame;  // what the log's ODOM lines show
    double time_s = 1.0;
    for (int scan = 0; scan < 40; ++scan) {
      for (int i = 0; i < 5; ++i) {
        const Pose2 step{0.1, 0.0, random.normal(0.0, 0.1)};
        wheels = wheels * step;
        in_line_frame = in_line_frame * step;
        wheel_poses.push_back(wheels);
        log += odometry_line(in_line_frame, time_s += 0.1);
      }
      const Pose2 error{random.normal(0.0, 0.1), random.normal(0.0, 0.1), random.normal(0.0, 0.1)};
      in_line_frame = in_line_frame * error;
      corrected.push_back(in_line_frame);
      log += scan_line(in_line_frame, time_s) + "NEFF 12.3\n" + odometry_line(in_line_frame, 0.0);
    }
  }
};

class CarmenLog : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& text) const {
    const auto file = folder_.path() / "drive.log";
    write_bytes(file, text);
    return file;
  }
  std::filesystem::path packed(const std::string& text) const {
    const auto path = folder_.path() / "drive.log.gz";
    const gzFile file = gzopen(path.c_str(), "wb");
    gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
    gzclose(file);
    return path;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(CarmenLog, GivesBackTheWheelsOwnOdometryFromCorrectedPoses) {
  Random random(4);
  const CorrectedDrive drive(random);
  const Played played = play_all({path(drive.log)}, with_poses());
  const auto odometry = played.of<OdometryReading>();
  ASSERT_EQ(odometry.size(), drive.wheel_poses.size());
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    EXPECT_NEAR(distance(odometry[i].odom_T_base, drive.wheel_poses[i]), 0.0, 1e-9);
    EXPECT_NEAR(angle_between(odometry[i].odom_T_base.yaw, drive.wheel_poses[i].yaw), 0.0, 1e-9);
  }
  const auto poses = played.of<PoseReading>();
  ASSERT_EQ(poses.size(), drive.corrected.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_NEAR(distance(poses[i].map_T_base, drive.corrected[i]), 0.0, 1e-12);
  EXPECT_EQ(played.of<LaserScan>().size(), 40U);
  EXPECT_TRUE(played.report.problems.empty());
  EXPECT_TRUE(warns_of(played.report, "no magnetic field"));
}

TEST_F(CarmenLog, ReadsPackedAndPlainFilesAlike) {
  Random random(4);
  const CorrectedDrive drive(random);
  const auto plain = play_all({path(drive.log)}, with_poses());
  const auto gz = play_all({packed(drive.log)}, with_poses());
  ASSERT_EQ(plain.events.size(), gz.events.size());
  for (std::size_t i = 0; i < plain.events.size(); ++i)
    EXPECT_EQ(stamp_of(plain.events[i]), stamp_of(gz.events[i]));
  EXPECT_EQ(must(io::describe_recording(packed(drive.log))).format, "CARMEN log");
}

TEST_F(CarmenLog, ARawLogKeepsItsOdometry) {
  std::string log;
  for (int i = 0; i < 10; ++i)
    log += odometry_line({0.1 * i, 0.2, 0.3}, 1.0 + i) + scan_line({0.1 * i + 0.001, 0.2, 0.3}, 1.5 + i);
  const auto odometry = play_all({path(log)}).of<OdometryReading>();
  ASSERT_EQ(odometry.size(), 10U);
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_NEAR(odometry[i].odom_T_base.x, 0.1 * static_cast<double>(i), 1e-12);
}

TEST_F(CarmenLog, PosesComeOnlyWhenWanted) {
  EXPECT_TRUE(play_all({path(scan_line({1, 2, 0}, 1.0))}).of<PoseReading>().empty());
  EXPECT_EQ(play_all({path(scan_line({1, 2, 0}, 1.0))}, with_poses()).of<PoseReading>().size(), 1U);
}

TEST_F(CarmenLog, BeamsStandInStepsOfTheLaser) {
  for (const auto& [beams, step_deg] :
       std::vector<std::pair<int, double>>{{180, 1.0}, {181, 1.0}, {360, 0.5}, {361, 0.5}}) {
    const LaserScan scan = play_all({path(scan_line({}, 1.0, beams))}).of<LaserScan>().at(0);
    EXPECT_NEAR(scan.angle_min_rad, radians(-90.0), 1e-12);
    EXPECT_NEAR(scan.angle_increment_rad, radians(step_deg), 1e-12) << beams;
    EXPECT_EQ(scan.ranges_m.size(), static_cast<std::size_t>(beams));
  }
}

TEST_F(CarmenLog, TimesThatStandStillOrRunBackABitKeepTheOrderOfTheLines) {
  std::string log;
  const std::vector<double> times{10.0, 10.5, 10.5, 10.1, 10.4, 11.0};
  for (std::size_t i = 0; i < times.size(); ++i)
    log += odometry_line({0.1 * static_cast<double>(i), 0.0, 0.0}, times[i]);
  const Played played = play_all({path(log + scan_line({}, 11.0))});
  const auto odometry = played.of<OdometryReading>();
  ASSERT_EQ(odometry.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(odometry[i].odom_T_base.x, 0.1 * static_cast<double>(i), 1e-12);
  for (std::size_t i = 1; i < 6; ++i) EXPECT_LT(odometry[i - 1].stamp, odometry[i].stamp);
  EXPECT_EQ(problems(played.report, "times that stand still or run back"), 3U);
}

TEST_F(CarmenLog, DamagedLinesAreCounted) {
  const std::string log =
      "ODOM 1 2\nODOM 1 2 x 0 0 0 1 h 1\nODOM nan 0 0 0 0 0 1 h 1\nFLASER 180 1 2 3\nFLASER -1\n"
      "FLASER 99999999999 1\nODOM 1 2 3 0 0 0 1e300 h 1\nwhatever\n" +
      scan_line({}, 5.0);
  const Played played = play_all({path(log)});
  EXPECT_EQ(problems(played.report, "damaged lines"), 7U);
  EXPECT_EQ(played.of<LaserScan>().size(), 1U);
}

TEST_F(CarmenLog, WithoutScansIsRefused) {
  const auto played = try_play({path("ODOM 1 2 3 0 0 0 1 h 1\n")});
  ASSERT_FALSE(played.ok());
  EXPECT_NE(played.error().message().find("FLASER"), std::string::npos);
}

TEST_F(CarmenLog, APackedLogCutShortIsPlayedToItsLastLine) {
  Random random(4);
  const CorrectedDrive drive(random);
  const auto file = packed(drive.log);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  const Played played = play_all({file});
  EXPECT_TRUE(warns_of(played.report, "ends in the middle"));
  EXPECT_GT(played.of<LaserScan>().size(), 5U);
}

struct RealLog {
  const char* name;
  std::size_t scans;
  double position_m;  ///< rms error of the odometry from one scan to the next, as the data's README says
  double heading_deg;
};

class RealCarmenLog : public testing::TestWithParam<RealLog> {};

TEST_P(RealCarmenLog, HasTheOdometryErrorThatIsKnown) {
  const std::string name = std::string("carmen/") + GetParam().name + "-corrected.log.gz";
  MSTSL_REQUIRE_DATA(name);
  const Played played = play_all({data_file(name)}, with_poses());
  ASSERT_EQ(played.of<LaserScan>().size(), GetParam().scans);
  Pose2 odom_T_base;
  std::optional<std::pair<Pose2, Pose2>> last;  // corrected pose and odometry at the scan before
  double position_m2 = 0.0;
  double heading_rad2 = 0.0;
  for (const SensorEvent& event : played.events) {
    if (const auto* odometry = std::get_if<OdometryReading>(&event)) odom_T_base = odometry->odom_T_base;
    const auto* pose = std::get_if<PoseReading>(&event);
    if (pose == nullptr) continue;
    if (last) {
      const Pose2 error = between(between(last->first, pose->map_T_base), between(last->second, odom_T_base));
      position_m2 += error.position().squaredNorm();
      heading_rad2 += error.yaw * error.yaw;
    }
    last = {pose->map_T_base, odom_T_base};
  }
  const auto steps = static_cast<double>(GetParam().scans - 1);
  EXPECT_NEAR(std::sqrt(position_m2 / steps), GetParam().position_m, 0.005);
  EXPECT_NEAR(degrees(std::sqrt(heading_rad2 / steps)), GetParam().heading_deg, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Buildings, RealCarmenLog,
                         testing::Values(RealLog{"aces", 440, 0.07, 2.6}, RealLog{"intel", 910, 0.07, 3.5},
                                         RealLog{"freiburg-079", 4791, 0.045, 1.6},
                                         RealLog{"seattle", 241, 0.025, 5.2}),
                         [](const auto& log) {
                           std::string name = log.param.name;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace mstsl::test
