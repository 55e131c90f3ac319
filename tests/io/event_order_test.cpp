#include "io/log/event_order.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

#include "recording_support.hpp"

namespace mstsl::io {
namespace {

/// Pushes odometry readings and keeps what comes out.
class Ordered {
 public:
  explicit Ordered(double window_s = 1.0)
      : order_(window_s, "log", report, [this](const SensorEvent& event) {
          out.push_back(event);
          return out.size() < enough;
        }) {}

  bool push(double stamp_s, double log_time_s) {
    return order_.push(Stamp::from_seconds(log_time_s), OdometryReading{Stamp::from_seconds(stamp_s), {}});
  }
  bool push(double stamp_s) { return push(stamp_s, stamp_s); }
  void finish() { order_.finish(); }

  std::vector<std::int64_t> stamps() const {
    std::vector<std::int64_t> stamps;
    for (const SensorEvent& event : out) stamps.push_back(stamp_of(event).ns);
    return stamps;
  }

  PlayReport report;
  std::vector<SensorEvent> out;
  std::size_t enough = 1'000'000;

 private:
  EventOrder order_;
};

TEST(EventOrder, SortsWhatComesWithinTheWindow) {
  Random random(3);
  Ordered ordered;
  std::vector<double> stamps;
  for (int i = 0; i < 2000; ++i) stamps.push_back(1000.0 + 0.01 * i);
  // Swaps of neighbours up to 0.4 s apart keep every event within the window of one second.
  for (std::size_t i = 0; i + 40 < stamps.size(); ++i) std::swap(stamps[i], stamps[i + random.index(40)]);
  std::vector<double> within;
  double newest = 0.0;
  for (const double stamp : stamps) {
    newest = std::max(newest, stamp);
    if (stamp >= newest - 0.99) within.push_back(stamp);
    if (stamp >= newest - 0.99) ordered.push(stamp, newest);
  }
  ordered.finish();
  std::ranges::sort(within);
  EXPECT_EQ(ordered.stamps(), test::nanoseconds(within));
  EXPECT_TRUE(ordered.report.problems.empty());
}

TEST(EventOrder, KeepsTheOrderOfEqualStamps) {
  Ordered ordered;
  EventOrder order(1.0, "log", ordered.report, [&](const SensorEvent& event) {
    ordered.out.push_back(event);
    return true;
  });
  for (int i = 0; i < 50; ++i) order.push({5}, OdometryReading{{5}, {1.0 * i, 0.0, 0.0}});
  order.finish();
  ASSERT_EQ(ordered.out.size(), 50U);
  for (std::size_t i = 0; i < 50; ++i)
    EXPECT_EQ(std::get<OdometryReading>(ordered.out[i]).odom_T_base.x, static_cast<double>(i));
}

TEST(EventOrder, DropsAndCountsWhatIsTooLate) {
  Ordered ordered;
  for (const double stamp : {100.0, 101.0, 102.0, 103.0}) ordered.push(stamp);
  ordered.push(100.5, 103.1);
  ordered.push(104.0);
  ordered.finish();
  EXPECT_EQ(ordered.stamps(), test::nanoseconds({100.0, 101.0, 102.0, 103.0, 104.0}));
  EXPECT_EQ(test::problems(ordered.report, "late"), 1U);
}

TEST(EventOrder, OneStampFarInTheFutureDoesNoHarm) {
  Ordered ordered;
  for (int i = 0; i < 50; ++i) ordered.push(100.0 + i, 100.0 + i);
  ordered.push(9000.0, 150.0);
  for (int i = 50; i < 100; ++i) ordered.push(100.0 + i, 100.0 + i);
  ordered.finish();
  EXPECT_EQ(ordered.out.size(), 100U);
  EXPECT_EQ(test::problems(ordered.report, "future"), 1U);
  EXPECT_TRUE(ordered.report.warnings.empty());
}

TEST(EventOrder, GoesOnBehindAGapThatTheRecorderSawToo) {
  Ordered ordered;
  ordered.push(100.0);
  ordered.push(101.0);
  ordered.push(5000.0);
  ordered.push(5001.0);
  ordered.finish();
  EXPECT_EQ(ordered.stamps(), test::nanoseconds({100.0, 101.0, 5000.0, 5001.0}));
  EXPECT_EQ(test::problems(ordered.report, "jumps forward"), 1U);
  EXPECT_EQ(ordered.report.warnings.size(), 1U);
}

TEST(EventOrder, RestartsWhereTheClockRunsBack) {
  Ordered ordered;
  for (const double stamp : {100.0, 101.0, 102.0, 103.0, 20.0, 21.0}) ordered.push(stamp);
  ordered.finish();
  EXPECT_EQ(ordered.stamps(), test::nanoseconds({100.0, 101.0, 102.0, 103.0, 20.0, 20.0, 21.0}));
  ASSERT_TRUE(std::holds_alternative<OdometryRestart>(ordered.out[4]));
  EXPECT_EQ(test::problems(ordered.report, "jumps back"), 1U);
}

TEST(EventOrder, TheRestartStandsBeforeWhatIsSortedBehindIt) {
  Ordered ordered;
  for (const double stamp : {100.0, 101.0, 102.0, 20.5, 20.25, 20.0, 21.0})
    ordered.push(stamp, std::min(stamp, 102.0));
  ordered.finish();
  EXPECT_EQ(ordered.stamps(), test::nanoseconds({100.0, 101.0, 102.0, 20.0, 20.0, 20.25, 20.5, 21.0}));
  EXPECT_TRUE(std::holds_alternative<OdometryRestart>(ordered.out[3]));
}

TEST(EventOrder, AClockThatNeverStopsJumpingIsToldOfAFewTimes) {
  Ordered ordered;
  for (int i = 0; i < 400; ++i) ordered.push(100.0 * i);
  EXPECT_EQ(test::problems(ordered.report, "clock jumps"), 399U);
  EXPECT_EQ(ordered.report.warnings.size(), 5U);
}

TEST(EventOrder, AnythingAtAllComesOutInOrderBetweenRestarts) {
  Random random(9);
  for (int trial = 0; trial < 200; ++trial) {
    Ordered ordered;
    for (int i = 0; i < 300; ++i)
      ordered.push(random.chance(0.9) ? 50.0 + 0.1 * i : random.uniform(0.0, 1000.0),
                   random.uniform(0.0, 1000.0));
    ordered.finish();
    for (std::size_t i = 1; i < ordered.out.size(); ++i) {
      const bool restarts = std::holds_alternative<OdometryRestart>(ordered.out[i]);
      EXPECT_TRUE(restarts || stamp_of(ordered.out[i - 1]) <= stamp_of(ordered.out[i]));
    }
  }
}

TEST(EventOrder, BelievesALongRowThatTheRecorderDidNotSee) {
  Ordered ordered;
  for (int i = 0; i < 100; ++i) ordered.push(1000.0 + 0.1 * i);
  for (int i = 0; i < 300; ++i) ordered.push(500.0 + 0.1 * i, 1010.0 + 0.1 * i);
  ordered.finish();
  EXPECT_EQ(test::problems(ordered.report, "jumps back"), 1U);
  EXPECT_EQ(test::problems(ordered.report, "late"), 99U);
  EXPECT_EQ(ordered.out.size(), 100U + 1U + 201U);
  EXPECT_EQ(ordered.stamps().back(), test::nanoseconds({500.0 + 0.1 * 299}).front());
}

TEST(EventOrder, StopsWhenTheReceiverHasEnough) {
  Ordered ordered;
  ordered.enough = 3;
  bool goes_on = true;
  for (int i = 0; i < 100 && goes_on; ++i) goes_on = ordered.push(i);
  EXPECT_FALSE(goes_on);
  ordered.finish();
  EXPECT_EQ(ordered.out.size(), 3U);
}

TEST(EventOrder, HoldsNoMoreThanItMust) {
  Ordered ordered;
  for (int i = 0; i < 30'000; ++i) ordered.push(100.0);
  EXPECT_GE(ordered.out.size(), 10'000U);
}

}  // namespace
}  // namespace mstsl::io
