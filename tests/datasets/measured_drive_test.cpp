#include "mstsl/datasets/measured_drive.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/datasets/tubes.hpp"

#include "test_support.hpp"

namespace mstsl::datasets {
namespace {

/// A walk of 6 m along y = x / 2 in a field that changes along it.
std::vector<Fingerprint> walk() {
  std::vector<Fingerprint> rows(121);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double along_m = 0.05 * static_cast<double>(i);
    rows[i].position_m = Eigen::Vector2d(2.0, 1.0).normalized() * along_m;
    rows[i].field_uT = {20.0 + along_m, -3.0 * along_m, -40.0};
  }
  return rows;
}

std::shared_ptr<const sim::World> corridor_around(const std::vector<Fingerprint>& rows) {
  Path path_m;
  for (const Fingerprint& row : rows) path_m.push_back(row.position_m);
  return std::make_shared<const sim::World>(test::must(tube_plan(std::vector<Path>{path_m})));
}

struct Played {
  std::vector<SensorEvent> events;
  std::vector<PoseReading> truth;

  template <typename Reading>
  std::vector<Reading> all() const {
    std::vector<Reading> chosen;
    for (const SensorEvent& event : events)
      if (const auto* reading = std::get_if<Reading>(&event)) chosen.push_back(*reading);
    return chosen;
  }
};

Played played(const Log& log) {
  Played result;
  log.play({[&](const SensorEvent& event) { result.events.push_back(event); },
            [&](const PoseReading& pose) { result.truth.push_back(pose); }});
  return result;
}

class MeasuredDrive : public testing::Test {
 protected:
  std::vector<Fingerprint> rows_ = walk();
  std::shared_ptr<const sim::World> world_ = corridor_around(rows_);
  sim::RobotOptions robot_ = robot_with_real_magnetometer();

  MeasuredDrive() { robot_.lidar.rate_hz = 0.0; }
};

TEST_F(MeasuredDrive, ReadsTheFirstRowsFieldTurnedIntoTheBodyWhileItStands) {
  const Eigen::Matrix3d base_R_sensor =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  robot_.rig.base_T_magnetometer.linear() = base_R_sensor;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Played run = played(measured_run(world_, rows_, robot_, Random(seed)));
    const PoseReading& start = run.truth.front();
    EXPECT_LT((start.map_T_base.position() - rows_.front().position_m).norm(), 1e-12);
    const Eigen::Matrix3d map_R_base =
        Eigen::AngleAxisd(start.map_T_base.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d expected_uT = (map_R_base * base_R_sensor).transpose() * rows_.front().field_uT;
    EXPECT_LT((run.all<FieldReading>().front().sensor_field_uT - expected_uT).norm(), 1e-9);
  }
}

TEST_F(MeasuredDrive, ReadsTheMeasuredFieldAllAlongTheWay) {
  const Played run = played(measured_run(world_, rows_, robot_, Random(3)));
  const PathField field(rows_);
  std::size_t compared = 0;
  for (const FieldReading& reading : run.all<FieldReading>()) {
    const auto pose = std::find_if(run.truth.begin(), run.truth.end(),
                                   [&](const PoseReading& p) { return p.stamp == reading.stamp; });
    if (pose == run.truth.end()) continue;
    const Eigen::Vector3d map_uT =
        Eigen::AngleAxisd(pose->map_T_base.yaw, Eigen::Vector3d::UnitZ()) * reading.sensor_field_uT;
    EXPECT_LT((map_uT - field.field_uT(pose->map_T_base.position())).norm(), 1e-6);
    ++compared;
  }
  EXPECT_GT(compared, 300U);
}

TEST_F(MeasuredDrive, StartsWithAnyHeadingAndEndsAlongThePath) {
  double least_rad = kPi, greatest_rad = -kPi;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Played run = played(measured_run(world_, rows_, robot_, Random(seed)));
    least_rad = std::min(least_rad, run.truth.front().map_T_base.yaw);
    greatest_rad = std::max(greatest_rad, run.truth.front().map_T_base.yaw);
    EXPECT_NEAR(run.truth.back().map_T_base.yaw, std::atan2(1.0, 2.0), 1e-9);
    EXPECT_LT((run.truth.back().map_T_base.position() - rows_.back().position_m).norm(), 0.02);
  }
  EXPECT_LT(least_rad, -radians(120.0));
  EXPECT_GT(greatest_rad, radians(120.0));
}

TEST_F(MeasuredDrive, SeesItsCorridorsWalls) {
  robot_.lidar.rate_hz = 1.0;
  const auto scans = played(measured_run(world_, rows_, robot_, Random(1))).all<LaserScan>();
  ASSERT_FALSE(scans.empty());
  float nearest_m = 100.0F;
  for (const float range_m : scans.front().ranges_m)
    if (range_m >= scans.front().range_min_m) nearest_m = std::min(nearest_m, range_m);
  EXPECT_NEAR(nearest_m, 1.1F,
              0.25F);  // the laser is 0.2 m from the robot's middle, the walls 1.1 m from the path
}

TEST_F(MeasuredDrive, SaysTheSameEachTimeItIsPlayed) {
  const Log log = measured_run(world_, rows_, robot_, Random(2));
  const auto first = played(log).all<OdometryReading>();
  const auto second = played(log).all<OdometryReading>();
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].odom_T_base.x, second[i].odom_T_base.x);
}

TEST_F(MeasuredDrive, SurveysWithoutALidar) {
  robot_.lidar.rate_hz = 40.0;
  const Played survey = played(measured_survey(world_, rows_, robot_, Random(1)));
  EXPECT_TRUE(survey.all<LaserScan>().empty());
  EXPECT_FALSE(survey.all<FieldReading>().empty());
  EXPECT_NEAR(survey.truth.front().map_T_base.yaw, std::atan2(1.0, 2.0), 1e-9);
}

TEST_F(MeasuredDrive, OverPointsHearsNothingBetweenThem) {
  std::vector<Fingerprint> points;
  for (std::size_t i = 0; i < rows_.size(); i += 10) points.push_back(rows_[i]);
  const Played survey = played(point_survey(world_, points, robot_, Random(1)));
  const auto readings = survey.all<FieldReading>();
  EXPECT_LE(readings.size(), 3 * points.size());
  for (const Fingerprint& point : points)
    EXPECT_TRUE(std::any_of(readings.begin(), readings.end(), [&](const FieldReading& reading) {
      return std::abs(reading.sensor_field_uT.norm() - point.field_uT.norm()) < 0.1;
    }));
}

TEST(TurnAtStart, KeepsToRateAndAccelerationAndReachesTheHeading) {
  sim::Trajectory drive;
  drive.poses = {{1.0, 2.0, 0.3}, {1.01, 2.0, 0.3}};
  sim::MotionOptions motion;
  for (const double start_rad : {-3.1, -1.0, 0.29, 0.3, 2.0, 3.4}) {
    const sim::Trajectory whole = with_turn_at_start(drive, start_rad, motion);
    EXPECT_NEAR(angle_between(whole.poses.front().yaw, start_rad), 0.0, 1e-12);
    double last_rate = 0.0;
    for (std::size_t i = 1; i < whole.poses.size(); ++i) {
      const double rate = angle_between(whole.poses[i - 1].yaw, whole.poses[i].yaw) / whole.step_s;
      EXPECT_LE(std::abs(rate), motion.turn_rate_rad_s + 1e-9);
      EXPECT_LE(std::abs(rate - last_rate), (motion.turn_acceleration_rad_s2 + 1e-6) * whole.step_s * 1.001);
      last_rate = rate;
    }
    EXPECT_NEAR(whole.poses.back().yaw, 0.3, 1e-12);
    EXPECT_EQ(whole.poses[whole.poses.size() - 2].x, drive.poses.front().x);
    EXPECT_GE(whole.duration_s(), 2.0 * motion.standstill_s);
  }
}

}  // namespace
}  // namespace mstsl::datasets
