#include "mstsl/mapping/slam.hpp"

#include <cmath>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/mapping/track_drawer.hpp"
#include "mstsl/sim/drive.hpp"
#include "mstsl/sim/occupancy_map.hpp"
#include "mstsl/sim/run.hpp"

#include "test_support.hpp"

namespace mstsl {
namespace {

using test::must;

/// Drives from place to place in a simulated building: what the sensors said, and where the robot truly was.
struct Drive {
  Drive(const sim::World& world, std::uint64_t seed, double length_m, const sim::RobotOptions& options = {}) {
    sim::RobotOptions robot = options;
    robot.lidar.beams = 361;
    rig = robot.rig;
    const Random random(seed);
    sim::RunOptions run;
    run.length_m = length_m;
    const auto start = must(sim::random_waypoint(world, run, random.fork(0)));
    sim::Route route = must(sim::tour_from(world, start, run, random));
    route.start_yaw_rad = 0.0;
    sim::drive(world, robot, route, Stamp{}, random.fork(999),
               {[&](const SensorEvent& event) { events.push_back(event); },
                [&](const PoseReading& pose) { truth.add(pose.stamp, pose.map_T_base); }});
  }
  Rig rig;
  std::vector<SensorEvent> events;
  Trajectory truth;
};

template <typename Consumer>
void feed_to(Consumer& consumer, const std::vector<SensorEvent>& events) {
  for (const SensorEvent& event : events)
    std::visit(
        [&](const auto& reading) {
          if constexpr (requires { consumer.observe(reading); }) consumer.observe(reading);
        },
        event);
}

/// Largest distance between a drive's track and the truth, the frames laid over each other at `true_T_map`.
double worst_m(const Trajectory& track, const Trajectory& truth, const Pose2& true_T_map) {
  double worst = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (const auto at = track.at(truth[i].stamp, 1.0))
      worst = std::max(worst, distance(true_T_map * *at, truth[i].pose));
  return worst;
}

SlamTrack mapped(const Drive& drive, const SlamOptions& options = {}) {
  Slam slam(options);
  slam.begin_drive(drive.rig);
  feed_to(slam, drive.events);
  return must(slam.track());
}

TEST(Slam, FindsTheWayAndClosesLoopsRightly) {
  const sim::World world = must(sim::make_world("symmetric-loop", {}, Random(21)));
  const Drive drive(world, 22, 250.0);
  const SlamTrack track = mapped(drive);
  EXPECT_LT(worst_m(track.drives.front().map_T_base, drive.truth, drive.truth.front().pose), 0.5);
  EXPECT_GT(track.closures.size(), 20U);
  EXPECT_NEAR(track.way_m(), 250.0, 15.0);
  for (const Closure& c : track.closures) {
    const auto from = drive.truth.at(track.keyframes[c.from].stamp, 1.0);
    const auto to = drive.truth.at(track.keyframes[c.to].stamp, 1.0);
    ASSERT_TRUE(from && to);
    EXPECT_LT(distance(between(*from, *to), c.from_T_to), 0.4);
  }
}

TEST(Slam, IsTheSameEachTime) {
  const sim::World world = must(sim::make_world("office", {}, Random(23)));
  const Drive drive(world, 24, 80.0);
  const SlamTrack a = mapped(drive), b = mapped(drive);
  const Trajectory &x = a.drives.front().map_T_base, &y = b.drives.front().map_T_base;
  ASSERT_EQ(x.size(), y.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_EQ(x[i].pose.x, y[i].pose.x);
    EXPECT_EQ(x[i].pose.yaw, y[i].pose.yaw);
  }
}

TEST(Slam, JoinsAnotherDriveAtItsAnchor) {
  const sim::World world = must(sim::make_world("office", {}, Random(25)));
  const Drive first(world, 26, 150.0), second(world, 27, 60.0);
  Slam slam;
  slam.begin_drive(first.rig);
  feed_to(slam, first.events);
  const Pose2 true_T_map =
      first.truth.front().pose * inverse(must(slam.track()).drives[0].map_T_base.front().pose);
  // Known after 5 m, to 15 cm and 2 deg.
  const std::size_t then = second.truth.size() / 12;
  const Anchor anchor{second.truth[then].stamp,
                      inverse(true_T_map) * second.truth[then].pose * Pose2{0.1, -0.1, 0.03},
                      Eigen::Vector3d(0.02, 0.02, 1e-3).asDiagonal()};
  slam.begin_drive(second.rig, anchor);
  feed_to(slam, second.events);
  const SlamTrack both = must(slam.track());
  ASSERT_EQ(both.drives.size(), 2U);
  EXPECT_LT(worst_m(both.drives[0].map_T_base, first.truth, true_T_map), 0.5);
  EXPECT_LT(worst_m(both.drives[1].map_T_base, second.truth, true_T_map), 0.5);
  std::size_t across = 0;
  for (const Closure& c : both.closures)
    across += both.keyframes[c.from].drive == 0 && both.keyframes[c.to].drive == 1;
  EXPECT_GT(across, 5U);
}

TEST(Slam, GoesByScansAloneWhereThereAreNoWheels) {
  const sim::World world = must(sim::make_world("office", {}, Random(28)));
  const Drive drive(world, 29, 60.0);
  SlamOptions options;
  options.without_wheels = true;
  const SlamTrack track = mapped(drive, options);
  EXPECT_LT(worst_m(track.drives.front().map_T_base, drive.truth, drive.truth.front().pose), 0.6);
}

TEST(Slam, ComplainsOfWhatIsMissing) {
  const sim::World world = must(sim::make_world("office", {}, Random(30)));
  const Drive drive(world, 31, 10.0);
  for (const bool with_odometry : {false, true}) {
    Slam slam;
    slam.begin_drive(drive.rig);
    for (const SensorEvent& event : drive.events) {
      if (const auto* odometry = std::get_if<OdometryReading>(&event); odometry != nullptr && with_odometry)
        slam.observe(*odometry);
      if (const auto* scan = std::get_if<LaserScan>(&event); scan != nullptr && !with_odometry)
        slam.observe(*scan);
    }
    const auto track = slam.track();
    ASSERT_FALSE(track.ok());
    EXPECT_NE(track.error().message().find(with_odometry ? "no scan" : "no odometry"), std::string::npos);
  }
}

TEST(Slam, BearsScansThatSayNothing) {
  const sim::World world = must(sim::make_world("office", {}, Random(32)));
  Drive drive(world, 33, 30.0);
  Random random(1);
  for (SensorEvent& event : drive.events) {
    auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr || !random.chance(0.3)) continue;
    if (random.chance(0.5))
      scan->ranges_m.clear();
    else
      for (float& r : scan->ranges_m) r = std::nanf("");
  }
  const SlamTrack track = mapped(drive);
  EXPECT_LT(worst_m(track.drives.front().map_T_base, drive.truth, drive.truth.front().pose), 0.5);
}

TEST(TrackDrawer, DrawsTheBuildingWhereTheWayIsKnown) {
  const sim::World world = must(sim::make_world("office", {}, Random(34)));
  const Drive drive(world, 35, 60.0);
  TrackDrawer drawer;
  drawer.begin_drive(drive.rig, drive.truth);
  feed_to(drawer, drive.events);
  const OccupancyGrid drawn = must(drawer.grid()), real = sim::occupancy_map(world);
  std::size_t same = 0, other = 0;
  for (std::size_t i = 0; i < drawn.geometry().size(); ++i) {
    if (drawn.values()[i] != CellState::kFree) continue;
    const Eigen::Vector2d at = drawn.geometry().center_of(drawn.geometry().cell(i));
    (state_at(real, at) == CellState::kFree ? same : other) += 1;
  }
  EXPECT_GT(same, 10'000U);
  EXPECT_LT(static_cast<double>(other), 0.03 * static_cast<double>(same));
}

}  // namespace
}  // namespace mstsl
