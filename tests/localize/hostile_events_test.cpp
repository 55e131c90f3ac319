#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "mstsl/localize/two_step.hpp"

#include "hand_made_world.hpp"

namespace mstsl {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Harm {
  Random& random;

  double number() {
    return std::vector<double>{kNaN, kInf, -kInf, 1e300, -1e300, 0.0, 1e-300}[random.index(7)];
  }

  void operator()(OdometryReading& reading) {
    (random.chance(0.5) ? reading.odom_T_base.x : reading.odom_T_base.yaw) =
        random.chance(0.5) ? number() : random.uniform(-50, 50);
  }
  void operator()(FieldReading& reading) {
    reading.sensor_field_uT[static_cast<Eigen::Index>(random.index(3))] = number();
  }
  void operator()(LaserScan& scan) {
    switch (random.index(6)) {
      case 0:
        scan.ranges_m.clear();
        break;
      case 1:
        scan.angle_increment_rad = number();
        break;
      case 2:
        scan.angle_min_rad = number();
        break;
      case 3:
        std::fill(scan.ranges_m.begin(), scan.ranges_m.end(), static_cast<float>(number()));
        break;
      case 4:
        scan.time_increment_s = number();
        break;
      default:
        scan.range_max_m = number();
    }
  }
  template <typename Other>
  void operator()(Other&) {}
};

/// The events of a good drive with a share of them spoilt, lost, doubled, or out of order in time.
std::vector<SensorEvent> spoilt(std::vector<SensorEvent> events, double share, Random& random) {
  std::vector<SensorEvent> bad;
  for (SensorEvent& event : events) {
    if (random.chance(share)) std::visit(Harm{random}, event);
    if (random.chance(share))
      std::visit([&](auto& reading) { reading.stamp = reading.stamp + random.uniform(-5.0, 5.0); }, event);
    if (random.chance(share)) continue;
    bad.push_back(event);
    if (random.chance(share)) bad.push_back(event);
    if (random.chance(0.1 * share)) bad.emplace_back(OdometryRestart{stamp_of(event)});
    if (bad.size() > 1 && random.chance(share)) std::swap(bad.back(), bad[bad.size() - 2]);
  }
  return bad;
}

void expect_sane(const Estimate& estimate) {
  EXPECT_TRUE(estimate.covariance.allFinite());
  EXPECT_TRUE(estimate.probability >= 0.0 && estimate.probability < 0.99);
  EXPECT_TRUE(std::isfinite(estimate.travelled_m));
  EXPECT_EQ(estimate.map_T_base.has_value(), estimate.status == LocalizationStatus::kLocalized);
  if (estimate.map_T_base) {
    EXPECT_TRUE(estimate.map_T_base->is_finite());
  }
  double sum = 0.0;
  for (const Hypothesis& hypothesis : estimate.hypotheses) {
    EXPECT_TRUE(hypothesis.map_T_base.is_finite());
    sum += hypothesis.weight;
  }
  EXPECT_LE(sum, 1.0 + 1e-9);
}

TEST(HostileEvents, NeverCrashAndNeverGiveAPoseThatIsNoNumber) {
  const test::HandMadeWorld world;
  const Rig rig;
  const auto good = test::events_of(world, {{3.0, 1.0, radians(30)}, radians(-30), 0.0, 4.0}, rig);
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Random random(seed);
    TwoStep localizer(world.maps, rig);
    for (const SensorEvent& event : spoilt(good, seed < 4 ? 0.5 : 0.05, random)) {
      feed(localizer, event);
      if (std::holds_alternative<LaserScan>(event)) expect_sane(localizer.estimate());
    }
    expect_sane(localizer.estimate());
    (void)localizer.report();
  }
}

TEST(HostileEvents, ScansOfNoiseLeaveItSearching) {
  const test::HandMadeWorld world;
  Random random(1);
  auto events = test::events_of(world, {{3.0, 1.0, radians(30)}, radians(-30), 0.0, 6.0}, {});
  for (SensorEvent& event : events)
    if (auto* scan = std::get_if<LaserScan>(&event))
      for (float& range : scan->ranges_m) range = static_cast<float>(random.uniform(0.2, 29.0));
  TwoStep localizer(world.maps, {});
  for (const SensorEvent& event : events) {
    feed(localizer, event);
    EXPECT_FALSE(localizer.estimate().map_T_base);
  }
}

TEST(HostileEvents, AnEmptyStreamIsNoEstimate) {
  const test::HandMadeWorld world;
  const TwoStep localizer(world.maps, {});
  EXPECT_EQ(localizer.estimate().status, LocalizationStatus::kSearching);
  EXPECT_TRUE(localizer.estimate().hypotheses.empty());
}

}  // namespace
}  // namespace mstsl
