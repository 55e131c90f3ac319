#include "mstsl/mapping/survey_tracker.hpp"

#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/sim/drive.hpp"
#include "mstsl/sim/occupancy_map.hpp"
#include "mstsl/sim/survey.hpp"

#include "test_support.hpp"

namespace mstsl {
namespace {

using test::must;

/// A survey of a simulated building: the map, what the robot's sensors said, and where it truly was.
struct Survey {
  explicit Survey(const std::string& name, std::uint64_t seed, double length_m = 120.0)
      : world(must(sim::make_world(name, {}, Random(seed)))),
        walls(std::make_shared<const WallField>(sim::occupancy_map(world))) {
    robot.lidar.rate_hz = 10.0;
    robot.lidar.beams = 361;
    const sim::Route route =
        sim::truncated(must(sim::survey_routes(world, {.lane_spacing_m = 1.0})).front(), length_m);
    sim::drive(world, robot, route, Stamp{}, Random(seed + 1),
               {[&](const SensorEvent& event) { events.push_back(event); },
                [&](const PoseReading& pose) { truth.add(pose.stamp, pose.map_T_base); }});
  }

  Result<SurveyTrack> tracked(const Pose2& off_at_start = {}) const {
    SurveyTracker tracker(walls, robot.rig, truth.front().pose * off_at_start);
    for (const SensorEvent& event : events)
      std::visit(
          [&](const auto& reading) {
            if constexpr (requires { tracker.observe(reading); }) tracker.observe(reading);
          },
          event);
    return tracker.finish();
  }

  double rms_error_m(const SurveyTrack& track) const {
    double squares = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
      if (const auto pose = track.map_T_base.at(truth[i].stamp, 0.5)) {
        squares += (pose->position() - truth[i].pose.position()).squaredNorm();
        ++count;
      }
    EXPECT_GT(count, 0.95 * static_cast<double>(truth.size()));
    return std::sqrt(squares / static_cast<double>(count));
  }

  sim::RobotOptions robot;
  sim::World world;
  std::shared_ptr<const WallField> walls;
  std::vector<SensorEvent> events;
  Trajectory truth;
};

TEST(SurveyTracker, FindsASurveyToThreeCentimetres) {
  for (const char* world : {"corridor", "carpark", "office"}) {
    const Survey survey(world, 11);
    const SurveyTrack track = must(survey.tracked());
    EXPECT_LT(survey.rms_error_m(track), 0.03) << world;
    EXPECT_LT(track.typical_sd_m, 0.05) << world;
    EXPECT_NEAR(track.way_m, 120.0, 8.0) << world;
  }
}

TEST(SurveyTracker, NeedsTheStartOnlyRoughly) {
  const Survey survey("office", 12, 30.0);
  for (const Pose2& off : {Pose2{0.9, 0.4, 0.3}, Pose2{-0.7, -0.8, -0.3}, Pose2{0.0, 0.9, 0.35}})
    EXPECT_LT(survey.rms_error_m(must(survey.tracked(off))), 0.04) << off.x;
}

TEST(SurveyTracker, SaysThatTheStartIsElsewhere) {
  const Survey survey("office", 13, 20.0);
  SurveyTracker tracker(survey.walls, survey.robot.rig, {-500.0, 0.0, 0.0});
  for (const SensorEvent& event : survey.events) {
    if (const auto* odometry = std::get_if<OdometryReading>(&event)) tracker.observe(*odometry);
    if (const auto* scan = std::get_if<LaserScan>(&event)) tracker.observe(*scan);
  }
  const auto track = tracker.finish();
  ASSERT_FALSE(track.ok());
  EXPECT_NE(track.error().message().find("initial pose"), std::string::npos);
}

TEST(SurveyTracker, SaysWhereItWasLost) {
  Survey survey("office", 14, 40.0);
  // From half-way on the robot is somewhere else: what it scans has nothing to do with the map.
  const Stamp half = survey.truth[survey.truth.size() / 2].stamp;
  for (SensorEvent& event : survey.events)
    if (auto* scan = std::get_if<LaserScan>(&event); scan != nullptr && scan->stamp > half)
      for (std::size_t i = 0; i < scan->ranges_m.size(); ++i)
        scan->ranges_m[i] = 1.0F + 0.5F * static_cast<float>(std::sin(0.2 * static_cast<double>(i)));
  const auto track = survey.tracked();
  ASSERT_FALSE(track.ok());
  EXPECT_NE(track.error().message().find("lost at"), std::string::npos);
}

TEST(SurveyTracker, ComplainsOfWhatIsMissing) {
  const Survey survey("office", 15, 5.0);
  for (const bool with_odometry : {false, true}) {
    SurveyTracker tracker(survey.walls, survey.robot.rig, survey.truth.front().pose);
    for (const SensorEvent& event : survey.events)
      if (const auto* odometry = std::get_if<OdometryReading>(&event); odometry != nullptr && with_odometry)
        tracker.observe(*odometry);
    const auto track = tracker.finish();
    ASSERT_FALSE(track.ok());
    EXPECT_NE(track.error().message().find(with_odometry ? "no scan" : "no odometry"), std::string::npos);
  }
}

}  // namespace
}  // namespace mstsl
