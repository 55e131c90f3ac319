#include "mstsl/localize/joint/joint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "../hand_made_world.hpp"

namespace mstsl {
namespace {

std::vector<Estimate> run(Joint& localizer, const std::vector<SensorEvent>& events) {
  std::vector<Estimate> estimates;
  for (const SensorEvent& event : events) {
    feed(localizer, event);
    if (!std::holds_alternative<LaserScan>(event)) continue;
    if (const Estimate e = localizer.estimate(); e.stamp == stamp_of(event)) estimates.push_back(e);
  }
  return estimates;
}

test::Drive eastwards() { return {{3.0, 1.0, radians(30)}, 0.0, radians(-30), 8.0}; }

/// Adds to every reading of the magnetometer.
std::vector<SensorEvent> biased(std::vector<SensorEvent> events, const Eigen::Vector3d& bias_uT) {
  for (SensorEvent& event : events)
    if (auto* field = std::get_if<FieldReading>(&event)) field->sensor_field_uT += bias_uT;
  return events;
}

Rig tilted_rig() {
  Rig rig;
  rig.base_T_laser.translation() << 0.2, 0.0, 0.3;
  rig.base_T_magnetometer.translation() << -0.1, 0.15, 0.7;
  rig.base_T_magnetometer.linear() =
      (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()))
          .matrix();
  return rig;
}

class JointTest : public testing::Test {
 protected:
  test::HandMadeWorld world;
  std::shared_ptr<const joint::Maps> maps = joint::make_maps(world.maps);
  Rig rig = tilted_rig();
};

TEST_F(JointTest, LocalizesWithALargeBiasAndATiltedMagnetometerAndTellsTheBias) {
  const Eigen::Vector3d bias_uT(6, -4, 5);
  Joint localizer(maps, rig);
  const auto estimates = run(localizer, biased(test::events_of(world, eastwards(), rig), bias_uT));
  const Pose2 truth = test::driven(eastwards()).back().pose;
  ASSERT_EQ(estimates.back().status, LocalizationStatus::kLocalized);
  EXPECT_LT(distance(*estimates.back().map_T_base, truth), 0.05);
  EXPECT_LT(std::abs(angle_between(estimates.back().map_T_base->yaw, truth.yaw)), radians(1));
  ASSERT_TRUE(estimates.back().bias_uT);
  // A robot that drives straight on cannot tell a bias from what its motors add.
  EXPECT_LT((*estimates.back().bias_uT - bias_uT).norm(), 4.0);
}

TEST_F(JointTest, IsSilentUntilItIsSureAndNeverWrongAfter) {
  Joint localizer(maps, rig);
  const Trajectory truth = test::driven(eastwards());
  bool localized = false;
  for (const Estimate& e : run(localizer, test::events_of(world, eastwards(), rig))) {
    EXPECT_EQ(e.map_T_base.has_value(), e.status == LocalizationStatus::kLocalized);
    EXPECT_FALSE(localized && !e.map_T_base) << "flickers";
    localized = localized || e.map_T_base;
    if (e.map_T_base) {
      EXPECT_LT(distance(*e.map_T_base, *truth.at(e.stamp, 1.0)), 0.2);
      EXPECT_GE(e.probability, 0.5);
    }
    double sum = 0;
    for (const Hypothesis& h : e.hypotheses) sum += h.weight;
    EXPECT_LE(sum, 1 + 1e-9);
  }
  EXPECT_TRUE(localized);
}

TEST_F(JointTest, WithoutAFieldItListsThePlacesThatFit) {
  auto events = test::events_of(world, eastwards(), rig);
  std::erase_if(events, [](const SensorEvent& e) { return std::holds_alternative<FieldReading>(e); });
  Joint localizer(maps, rig);
  const auto estimates = run(localizer, events);
  const Trajectory truth = test::driven(eastwards());
  for (const Estimate& e : estimates) {
    // The walls may tell, but then they must tell the truth.
    if (e.map_T_base) EXPECT_LT(distance(*e.map_T_base, *truth.at(e.stamp, 1.0)), 0.5);
  }
  EXPECT_FALSE(estimates.back().hypotheses.empty());
  EXPECT_FALSE(estimates.back().bias_uT);
}

TEST_F(JointTest, FindsARobotThatWasCarriedAway) {
  const test::Drive first = eastwards(), second{{21.0, 9.0, radians(180)}, 0.0, 0.0, 8.0};
  auto events = test::events_of(world, first, rig);
  const Stamp end = stamp_of(events.back());
  auto more = test::events_of(world, second, rig);
  Pose2 odom_T_end;
  for (const SensorEvent& event : events)
    if (const auto* odometry = std::get_if<OdometryReading>(&event)) odom_T_end = odometry->odom_T_base;
  const double pause_s = end - stamp_of(more.front()) + 0.02;
  const Pose2 odom_T_start = std::get<OdometryReading>(more.front()).odom_T_base;
  for (SensorEvent& event : more) {
    std::visit([&](auto& reading) { reading.stamp = reading.stamp + pause_s; }, event);
    if (auto* odometry = std::get_if<OdometryReading>(&event))
      odometry->odom_T_base = odom_T_end * between(odom_T_start, odometry->odom_T_base);
    events.push_back(event);
  }
  Joint localizer(maps, rig);
  bool lost = false;
  Estimate last;
  for (const Estimate& e : run(localizer, events))
    lost = lost || e.status == LocalizationStatus::kLost, last = e;
  EXPECT_TRUE(lost);
  ASSERT_TRUE(last.map_T_base);
  EXPECT_LT(distance(*last.map_T_base, test::driven(second).back().pose), 0.15);
}

TEST_F(JointTest, GivesTheSameEstimatesAtAnyNumberOfThreads) {
  const auto events = test::events_of(world, eastwards(), rig);
  JointOptions one_thread, three_threads;
  one_thread.bank.threads = {1};
  three_threads.bank.threads = {3};
  Joint one(maps, rig, one_thread), three(maps, rig, three_threads);
  const auto a = run(one, events), b = run(three, events);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].probability, b[i].probability);
    EXPECT_EQ(a[i].covariance, b[i].covariance);
    ASSERT_EQ(a[i].hypotheses.size(), b[i].hypotheses.size());
    for (std::size_t k = 0; k < a[i].hypotheses.size(); ++k)
      EXPECT_EQ(a[i].hypotheses[k].map_T_base.x, b[i].hypotheses[k].map_T_base.x);
  }
}

TEST_F(JointTest, WaitsForOdometryThatComesSeldom) {
  auto events = test::events_of(world, eastwards(), rig);
  int odometry = 0;
  std::erase_if(events, [&](const SensorEvent& e) {
    return std::holds_alternative<OdometryReading>(e) && odometry++ % 20 != 0;  // 2.5 Hz
  });
  Joint localizer(maps, rig);
  const auto estimates = run(localizer, events);
  ASSERT_FALSE(estimates.empty());
  ASSERT_TRUE(estimates.back().map_T_base);
  EXPECT_GT(localizer.report().counts.at("field stations"), 40u);
}

TEST_F(JointTest, FindsItselfByTheFieldAloneWhereTheLidarSeesNothing) {
  auto events = biased(test::events_of(world, eastwards(), rig), {3, -2, 2});
  for (SensorEvent& event : events)
    if (auto* scan = std::get_if<LaserScan>(&event))
      std::ranges::fill(scan->ranges_m, std::numeric_limits<float>::infinity());
  Joint localizer(maps, rig);
  const auto estimates = run(localizer, events);
  const Pose2 truth = test::driven(eastwards()).back().pose;
  ASSERT_TRUE(estimates.back().map_T_base);
  EXPECT_LT(distance(*estimates.back().map_T_base, truth), 0.3);
  EXPECT_GT(localizer.report().counts.at("searches by the field alone"), 0u);
}

TEST_F(JointTest, DoesNotHoardReadingsForOdometryThatNeverComes) {
  Joint localizer(maps, rig);
  for (int i = 0; i < 5000; ++i)
    localizer.observe(FieldReading{Stamp::from_seconds(0.01 * i), {20.0, 0.0, -40.0}});
  EXPECT_GT(localizer.report().counts.at("field readings dropped (no odometry near their time)"), 4600u);
}

TEST(JointOptions, AreRefusedWhereTheyMakeNoSense) {
  EXPECT_FALSE(invalid(JointOptions{}));
  const auto refused = [](auto change) {
    JointOptions options;
    change(options);
    return invalid(options).has_value();
  };
  EXPECT_TRUE(refused([](JointOptions& o) { o.localized_from = 1.5; }));
  EXPECT_TRUE(refused([](JointOptions& o) { o.lost_below = 0.9995; }));
  EXPECT_TRUE(refused([](JointOptions& o) { o.agree_m = std::nan(""); }));
  EXPECT_TRUE(refused([](JointOptions& o) { o.bank.field.map_error_floor_uT = 0.0; }));
  EXPECT_TRUE(refused([](JointOptions& o) { o.bank.field_temper = -0.1; }));
}

}  // namespace
}  // namespace mstsl
