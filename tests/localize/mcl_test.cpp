#include "mstsl/localize/baselines/mcl.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "hand_made_world.hpp"

namespace mstsl {
namespace {

MclOptions expert() {
  MclOptions options;
  options.particles_per_m2 = 280.0;
  options.sigma_hit_m = 0.1, options.hit_share = 0.8, options.random_share = 0.2;
  options.alpha = 0.05, options.temper = 0.05, options.kld_error = 0.01;
  return options;
}

/// Along the lower corridor and round the corner. The building looks nearly the same under half a turn.
std::vector<SensorEvent> drive(const test::HandMadeWorld& world) {
  std::vector<SensorEvent> events;
  Stamp stamp = Stamp::from_seconds(100.0);
  Pose2 at{16.0, 1.0, 0.0};
  for (int i = 0; i < 180; ++i) {
    events.emplace_back(OdometryReading{stamp, at});
    events.emplace_back(world.scan_at(stamp, world.map_T_world * at, Eigen::Isometry3d::Identity()));
    at = at * (at.x < 22.6 ? Pose2{0.15, 0, 0} : Pose2{0.15, 0, at.yaw < radians(80) ? radians(18) : 0.0});
    stamp = stamp + 0.2;
    if (at.y > 8.0) break;
  }
  return events;
}

std::vector<Pose2> means(Mcl& mcl, const std::vector<SensorEvent>& events) {
  std::vector<Pose2> poses;
  for (const SensorEvent& event : events) {
    feed(mcl, event);
    if (std::holds_alternative<LaserScan>(event)) poses.push_back(mcl.estimate().hypotheses.at(0).map_T_base);
  }
  return poses;
}

bool same(const std::vector<Pose2>& a, const std::vector<Pose2>& b) {
  return std::ranges::equal(
      a, b, [](const Pose2& p, const Pose2& q) { return p.x == q.x && p.y == q.y && p.yaw == q.yaw; });
}

TEST(Mcl, DrawsTheSameWhateverOthersDraw) {
  const test::HandMadeWorld world;
  std::vector<SensorEvent> events = drive(world);
  events.resize(40);
  Mcl alone(world.maps, Rig{}, expert());
  const std::vector<Pose2> expected = means(alone, events);
  Mcl first(world.maps, Rig{}, expert()), other(world.maps, Rig{}, expert());
  std::vector<Pose2> interleaved;
  for (const SensorEvent& event : events) {
    feed(first, event);
    feed(other, event);
    if (std::holds_alternative<LaserScan>(event))
      interleaved.push_back(first.estimate().hypotheses.at(0).map_T_base);
  }
  EXPECT_TRUE(same(expected, interleaved));
  MclOptions reseeded = expert();
  reseeded.seed = 2;
  Mcl another(world.maps, Rig{}, reseeded);
  EXPECT_FALSE(same(expected, means(another, events)));
}

TEST(Mcl, EndsAtTheTruthOrAtItsTwin) {
  for (const Pose2& map_T_world : {Pose2{}, Pose2{30, -20, 1.2}}) {
    const test::HandMadeWorld world(map_T_world);
    const std::vector<SensorEvent> events = drive(world);
    Mcl mcl(world.maps, Rig{}, expert());
    const Pose2 found = inverse(map_T_world) * means(mcl, events).back();
    const Pose2 truth = std::get<OdometryReading>(events[events.size() - 2]).odom_T_base;
    const Pose2 twin = Pose2{24, 10, kPi} * truth;
    ASSERT_EQ(mcl.estimate().status, LocalizationStatus::kLocalized);
    const double off_m = std::min(distance(found, truth), distance(found, twin));
    EXPECT_LT(off_m, 0.3) << "at " << found.x << " " << found.y << " " << found.yaw;
    EXPECT_GT(mcl.estimate().probability, 0.5);
  }
}

}  // namespace
}  // namespace mstsl
