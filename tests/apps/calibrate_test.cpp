#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "mstsl/io/calibration_file.hpp"

#include "run_app.hpp"
#include "site.hpp"

namespace mstsl::test {
namespace {

const Eigen::Vector3d kHardIron_uT(11.0, -6.0, 2.0);

/// The site's run with iron on the robot.
std::vector<SensorEvent> with_iron(std::vector<SensorEvent> events) {
  for (SensorEvent& event : events)
    if (auto* field = std::get_if<FieldReading>(&event)) field->sensor_field_uT += kHardIron_uT;
  return events;
}

/// Two turns on the spot, two metres apart.
std::vector<SensorEvent> turning_drive() {
  std::vector<SensorEvent> events;
  Pose2 pose;
  const auto tick = [&](const Eigen::Vector3d& map_field_uT) {
    const Stamp stamp = Stamp::from_seconds(100.0 + 0.02 * static_cast<double>(events.size()));
    events.push_back(OdometryReading{stamp, pose});
    const Eigen::Matrix3d base_R_map =
        Eigen::AngleAxisd(-pose.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    events.push_back(FieldReading{stamp, base_R_map * map_field_uT + kHardIron_uT});
  };
  for (const Eigen::Vector3d& field_uT : {Eigen::Vector3d(22, 3, -40), Eigen::Vector3d(15, -9, -36)}) {
    for (int i = 0; i < 180; ++i) {
      pose = pose * Pose2{0.0, 0.0, 2 * kPi / 180};
      tick(field_uT);
    }
    for (int i = 0; i < 40; ++i) {
      pose = pose * Pose2{0.05, 0.0, 0.0};
      tick(field_uT);
    }
  }
  return events;
}

TEST(Calibrate, WritesAFileThatMakesAnUncalibratedRobotsFieldTheMaps) {
  const Site& site = Site::get();
  site.write_log("turns.mcap", turning_drive());
  site.write_log("iron.mcap", with_iron(site.events()));
  const std::string file = site.path("calibration.yaml").string();
  const Printed made = run_app("calibrate -o " + file + " " + site.path("turns.mcap").string());
  EXPECT_EQ(made.exit_status, 0) << made.text;
  EXPECT_TRUE(made.says("2 turns on the spot")) << made.text;
  EXPECT_TRUE(made.says("not shown by turning in the plane"));
  const auto read = must(io::read_calibration(file));
  EXPECT_LT((read.hard_iron_uT - kHardIron_uT).head<2>().norm(), 0.05);
  EXPECT_EQ(read.hard_iron_uT.z(), 0.0);
  // The paper's method knows no bias: with the iron it must be worse off than with the calibration.
  const std::string two_step = " --method two-step --quiet";
  EXPECT_EQ(run_app(site.localize("run.mcap", "plain.jsonl", two_step)).exit_status, 0);
  EXPECT_EQ(
      run_app(site.localize("iron.mcap", "calibrated.jsonl", "--calibration " + file + two_step)).exit_status,
      0);
  const Printed judged = run_app("evaluate --truth " + site.path("truth.csv").string() + " " +
                                 site.path("calibrated.jsonl").string());
  EXPECT_TRUE(judged.says("right at the end                             100.0 %")) << judged.text;
}

TEST(Calibrate, SaysWhatIsMissing) {
  const Site& site = Site::get();
  const std::string output = " -o " + site.path("never.yaml").string() + " ";
  const Printed no_turn = run_app("calibrate" + output + site.path("run.mcap").string());
  EXPECT_EQ(no_turn.exit_status, 1);
  EXPECT_TRUE(no_turn.says("turn on the spot")) << no_turn.text;
  const Printed no_topic = run_app("calibrate --field-topic /none" + output + site.path("run.mcap").string());
  EXPECT_EQ(no_topic.exit_status, 1);
  EXPECT_TRUE(no_topic.says("/none")) << no_topic.text;
  EXPECT_FALSE(std::filesystem::exists(site.path("never.yaml")));
  const Printed bad =
      run_app(site.localize("run.mcap", "never.jsonl", "--calibration " + site.path("map.yaml").string()));
  EXPECT_EQ(bad.exit_status, 1);
  EXPECT_TRUE(bad.says("hard_iron_uT")) << bad.text;
}

}  // namespace
}  // namespace mstsl::test
