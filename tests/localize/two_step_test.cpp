#include "mstsl/localize/two_step.hpp"

#include <gtest/gtest.h>

#include "hand_made_world.hpp"

namespace mstsl {
namespace {

std::vector<Estimate> run(TwoStep& localizer, const std::vector<SensorEvent>& events) {
  std::vector<Estimate> estimates;
  for (const SensorEvent& event : events) {
    feed(localizer, event);
    if (!std::holds_alternative<LaserScan>(event)) continue;
    if (const Estimate e = localizer.estimate(); e.stamp == stamp_of(event)) estimates.push_back(e);
  }
  return estimates;
}

/// The southern corridor from x = 3 on, at first 30 deg off its direction.
test::Drive eastwards(double first_turn_rad) {
  return {{3.0, 1.0, radians(30)}, first_turn_rad, radians(-30) - first_turn_rad, 8.0};
}

PoseReading truth_at_end(const test::Drive& drive) {
  const Trajectory truth = test::driven(drive);
  return {truth.back().stamp, truth.back().pose};
}

Rig rig_with_sensors_off_centre() {
  Rig rig;
  rig.base_T_laser.translation() << 0.2, 0.0, 0.3;
  rig.base_T_magnetometer.translation() << -0.1, 0.15, 0.7;
  return rig;
}

class TwoStepTest : public testing::Test {
 protected:
  test::HandMadeWorld world;
  Rig rig = rig_with_sensors_off_centre();
};

TEST_F(TwoStepTest, LocalizesARobotThatTurnsByBeta) {
  const test::Drive drive = eastwards(radians(-30));
  TwoStep localizer(world.maps, rig);
  const auto estimates = run(localizer, test::events_of(world, drive, rig));
  ASSERT_EQ(estimates.back().status, LocalizationStatus::kLocalized);
  EXPECT_LT(distance(*estimates.back().map_T_base, truth_at_end(drive).map_T_base), 0.1);
  EXPECT_LT(std::abs(estimates.back().map_T_base->yaw), radians(1));
}

TEST_F(TwoStepTest, LocalizesARobotThatCannotBeCommanded) {
  const test::Drive drive = eastwards(0.0);
  TwoStep localizer(world.maps, rig);
  const auto estimates = run(localizer, test::events_of(world, drive, rig));
  ASSERT_TRUE(estimates.back().map_T_base);
  EXPECT_LT(distance(*estimates.back().map_T_base, truth_at_end(drive).map_T_base), 0.1);
}

TEST_F(TwoStepTest, GivesNoPoseBeforeItIsKnownAndHypothesesBeforeThat) {
  TwoStep localizer(world.maps, rig);
  bool localized = false, compared = false;
  for (const Estimate& e : run(localizer, test::events_of(world, eastwards(radians(-30)), rig))) {
    localized = localized || e.status == LocalizationStatus::kLocalized;
    compared = compared || !e.hypotheses.empty();
    EXPECT_EQ(e.map_T_base.has_value(), localized);
    EXPECT_EQ(e.probability > 0.0, localized);
    if (localized) {
      EXPECT_TRUE(compared);
    }
  }
  EXPECT_TRUE(localized);
}

TEST_F(TwoStepTest, GivesTheSameEstimatesAtAnyNumberOfThreads) {
  const auto events = test::events_of(world, eastwards(radians(-30)), rig);
  const auto with_threads = [&](int threads) {
    const auto maps =
        test::must(make_localization_maps(world.map, world.field_map(), {.threads = {threads}}));
    TwoStep localizer(maps, rig);
    return run(localizer, events);
  };
  const auto one = with_threads(1), two = with_threads(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].map_T_base.has_value(), two[i].map_T_base.has_value());
    ASSERT_EQ(one[i].hypotheses.size(), two[i].hypotheses.size());
    EXPECT_EQ(one[i].covariance, two[i].covariance);
    for (std::size_t k = 0; k < one[i].hypotheses.size(); ++k) {
      EXPECT_EQ(one[i].hypotheses[k].weight, two[i].hypotheses[k].weight);
      EXPECT_EQ(one[i].hypotheses[k].map_T_base.x, two[i].hypotheses[k].map_T_base.x);
    }
  }
}

TEST_F(TwoStepTest, MovesItsAnswersWithTheWorld) {
  const Pose2 moved_T_map{40.0, -25.0, radians(35)};
  const test::HandMadeWorld moved(moved_T_map);
  test::Drive here = eastwards(radians(-30)), there = here;
  there.map_T_start = moved_T_map * here.map_T_start;
  TwoStep localizer(world.maps, rig), elsewhere(moved.maps, rig);
  const auto a = run(localizer, test::events_of(world, here, rig));
  const auto b = run(elsewhere, test::events_of(moved, there, rig));
  ASSERT_TRUE(a.back().map_T_base);
  ASSERT_TRUE(b.back().map_T_base);
  const Pose2 expected = moved_T_map * *a.back().map_T_base;
  EXPECT_LT(distance(*b.back().map_T_base, expected),
            0.08);  // the walls are drawn anew in other cells of 5 cm
  EXPECT_LT(std::abs(angle_between(b.back().map_T_base->yaw, expected.yaw)), radians(0.3));
}

/// The events of two drives, the robot carried from the end of the first to the start of the second while its
/// wheels stand still.
std::vector<SensorEvent> carried_between(const test::HandMadeWorld& world, const test::Drive& first,
                                         const test::Drive& second, const Rig& rig) {
  std::vector<SensorEvent> events = test::events_of(world, first, rig);
  const Stamp end = stamp_of(events.back());
  Pose2 odom_T_end;
  for (const SensorEvent& event : events)
    if (const auto* odometry = std::get_if<OdometryReading>(&event)) odom_T_end = odometry->odom_T_base;
  std::vector<SensorEvent> more = test::events_of(world, second, rig);
  const double pause_s = end - stamp_of(more.front()) + 0.02;
  const Pose2 odom_T_start = std::get<OdometryReading>(more.front()).odom_T_base;
  for (SensorEvent& event : more) {
    std::visit([&](auto& reading) { reading.stamp = reading.stamp + pause_s; }, event);
    if (auto* odometry = std::get_if<OdometryReading>(&event))
      odometry->odom_T_base = odom_T_end * between(odom_T_start, odometry->odom_T_base);
    events.push_back(event);
  }
  return events;
}

TEST_F(TwoStepTest, SaysThatARobotCarriedAwayIsLostAndFindsItAgain) {
  const test::Drive first = eastwards(radians(-30));
  // Into each of the other corridors; the last looks so much like the first that it takes 5 m to notice.
  for (const test::Drive& second : {test::Drive{{21.0, 9.0, radians(180)}, 0.0, 0.0, 8.0},
                                    test::Drive{{23.0, 1.5, radians(90)}, 0.0, 0.0, 7.0},
                                    test::Drive{{1.0, 1.0, radians(90)}, 0.0, 0.0, 8.0},
                                    test::Drive{{1.0, 2.5, radians(90)}, 0.0, 0.0, 7.0}}) {
    SCOPED_TRACE(testing::Message() << "carried to " << second.map_T_start.x << ", " << second.map_T_start.y);
    TwoStep localizer(world.maps, rig);
    bool lost = false;
    Estimate last;
    for (const Estimate& e : run(localizer, carried_between(world, first, second, rig))) {
      lost = lost || e.status == LocalizationStatus::kLost;
      EXPECT_EQ(e.map_T_base.has_value(), e.status == LocalizationStatus::kLocalized);
      last = e;
    }
    EXPECT_TRUE(lost);
    ASSERT_TRUE(last.map_T_base);
    EXPECT_LT(distance(*last.map_T_base, test::driven(second).back().pose), 0.15);
    EXPECT_LT(std::abs(angle_between(last.map_T_base->yaw, second.map_T_start.yaw)), radians(1));
  }
}

TEST_F(TwoStepTest, KeepsItsPoseOverARestartOfTheOdometry) {
  const test::Drive drive = eastwards(radians(-30));
  auto events = test::events_of(world, drive, rig);
  const Stamp restart = events[events.size() - 200 * 2].index() == 0 ? stamp_of(events[events.size() - 400])
                                                                     : stamp_of(events[events.size() - 401]);
  std::optional<Pose2> odom_T_restart;
  std::vector<SensorEvent> restarted;
  for (SensorEvent event : events) {
    auto* odometry = std::get_if<OdometryReading>(&event);
    if (odometry != nullptr && odometry->stamp >= restart) {
      if (!odom_T_restart)
        odom_T_restart = odometry->odom_T_base, restarted.emplace_back(OdometryRestart{restart});
      odometry->odom_T_base = between(*odom_T_restart, odometry->odom_T_base);
    }
    restarted.push_back(event);
  }
  TwoStep localizer(world.maps, rig);
  const auto estimates = run(localizer, restarted);
  ASSERT_TRUE(estimates.back().map_T_base);
  EXPECT_LT(distance(*estimates.back().map_T_base, truth_at_end(drive).map_T_base), 0.1);
  EXPECT_EQ(localizer.report().counts.at("odometry interruptions"), 1u);
}

TEST_F(TwoStepTest, WithoutAFieldItSaysSoAndStaysSilent) {
  TwoStep localizer(world.maps, rig);
  auto events = test::events_of(world, eastwards(0.0), rig);
  std::erase_if(events, [](const SensorEvent& e) { return std::holds_alternative<FieldReading>(e); });
  for (const Estimate& e : run(localizer, events)) EXPECT_FALSE(e.map_T_base);
  ASSERT_EQ(localizer.report().warnings.size(), 1u);
  EXPECT_NE(localizer.report().warnings[0].find("field reading"), std::string::npos);
}

TEST(TwoStepOptions, AreRefusedWithASentenceWhereTheyMakeNoSense) {
  EXPECT_FALSE(invalid(TwoStepOptions{}));
  TwoStepOptions none, shares, sigmas, distances, nan;
  none.initialise.distinct.count = 0;
  shares.lidar.min_score = 1.5;
  sigmas.lidar.max_sigma_m = 0.1;
  distances.lidar.answer_distance_m = 0.5;
  nan.initialise.field_sigma_uT = std::numeric_limits<double>::quiet_NaN();
  for (const TwoStepOptions& options : {none, shares, sigmas, distances, nan}) EXPECT_TRUE(invalid(options));
  EXPECT_NE(invalid(shares)->message().find("min_score is 1.5"), std::string::npos);
}

TEST(LocalizationMaps, OfTwoPlacesAreRefused) {
  const test::HandMadeWorld here, elsewhere(Pose2{13.0, 4.0, 0.3});
  const auto maps = make_localization_maps(here.map, elsewhere.field_map());
  ASSERT_FALSE(maps);
  EXPECT_NE(maps.error().message().find("of another place"), std::string::npos);
}

TEST(LocalizationMaps, NeedFreeCellsAndWalls) {
  const test::HandMadeWorld world;
  const OccupancyGrid unknown(world.map.geometry(), CellState::kUnknown),
      free(world.map.geometry(), CellState::kFree);
  EXPECT_FALSE(make_localization_maps(unknown, world.field_map()));
  EXPECT_FALSE(make_localization_maps(free, world.field_map()));
}

}  // namespace
}  // namespace mstsl
