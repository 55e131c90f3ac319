#include "mstsl/mapping/restart_watch.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

/// A second of readings around a value.
void stand(RestartWatch& watch, const Eigen::Vector3d& field_uT, Random& random, double from_s) {
  for (int i = 0; i < 100; ++i) {
    FieldReading reading;
    reading.stamp = Stamp::from_seconds(from_s + 0.01 * i);
    for (int c = 0; c < 3; ++c) reading.sensor_field_uT(c) = field_uT(c) + random.normal(0, 0.5);
    watch.observe(reading);
  }
}

TEST(RestartWatch, TellsARobotThatStoodStillFromOneThatWasMoved) {
  Random random(1);
  RestartWatch watch;
  stand(watch, {20.0, 5.0, -40.0}, random, 0.0);
  watch.observe(OdometryRestart{Stamp::from_seconds(1.0)});
  stand(watch, {20.5, 5.0, -41.0}, random, 1.0);
  EXPECT_TRUE(watch.jumps().empty());
  watch.observe(OdometryRestart{Stamp::from_seconds(2.0)});
  stand(watch, {8.0, 9.0, -44.0}, random, 2.0);
  ASSERT_EQ(watch.jumps().size(), 1U);
  EXPECT_NEAR(watch.jumps()[0].change_uT, 13.5, 1.0);
  EXPECT_GE(watch.jumps()[0].stamp, Stamp::from_seconds(2.0));
}

TEST(RestartWatch, DrivingAwayIsNoJumpAndNeitherAreReadingsThatAreNone) {
  Random random(2);
  RestartWatch watch;
  watch.observe(OdometryRestart{});  // before anything was read
  stand(watch, {20.0, 5.0, -40.0}, random, 0.0);
  stand(watch, {40.0, 5.0, -40.0}, random, 1.0);  // without a restart
  watch.observe(OdometryRestart{});
  FieldReading none;
  none.sensor_field_uT.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < 50; ++i) watch.observe(none);
  stand(watch, {40.0, 5.0, -40.0}, random, 2.0);
  EXPECT_TRUE(watch.jumps().empty());
}

}  // namespace
}  // namespace mstsl
