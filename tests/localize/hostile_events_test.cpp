#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "mstsl/localize/methods.hpp"

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

/// `most_sure`: events that are spoilt make nobody surer than this.
void expect_sane(const Estimate& estimate, double most_sure) {
  EXPECT_TRUE(estimate.covariance.allFinite());
  EXPECT_TRUE(estimate.probability >= 0.0 && estimate.probability <= most_sure);
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

class HostileEvents : public testing::TestWithParam<std::string> {
 protected:
  AnyLocalizer localizer() const { return factory(rig); }

  test::HandMadeWorld world;
  Rig rig;
  LocalizerFactory factory = test::must(make_method(GetParam(), world.maps));
};

TEST_P(HostileEvents, NeverCrashAndNeverGiveAPoseThatIsNoNumber) {
  // The joint method may well be sure where only some of the events are bad.
  const double most_sure = GetParam() == "two-step" ? 0.99 : 1.0 + 1e-9;
  const auto good = test::events_of(world, {{3.0, 1.0, radians(30)}, radians(-30), 0.0, 4.0}, rig);
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Random random(seed);
    AnyLocalizer any = localizer();
    for (const SensorEvent& event : spoilt(good, seed < 4 ? 0.5 : 0.05, random)) {
      feed(any, event);
      if (std::holds_alternative<LaserScan>(event)) expect_sane(any.estimate(), most_sure);
    }
    expect_sane(any.estimate(), most_sure);
    (void)any.report();
  }
}

TEST_P(HostileEvents, ScansOfNoiseLeaveItSearching) {
  if (GetParam().starts_with("mcl"))
    GTEST_SKIP() << "Monte-Carlo localization converges on whatever fits least ill: it knows no doubt";
  if (GetParam().starts_with("mag-pf")) GTEST_SKIP() << "hears the field alone, which is good here";
  Random random(1);
  auto events = test::events_of(world, {{3.0, 1.0, radians(30)}, radians(-30), 0.0, 6.0}, {});
  for (SensorEvent& event : events)
    if (auto* scan = std::get_if<LaserScan>(&event))
      for (float& range : scan->ranges_m) range = static_cast<float>(random.uniform(0.2, 29.0));
  AnyLocalizer any = localizer();
  for (const SensorEvent& event : events) {
    feed(any, event);
    EXPECT_FALSE(any.estimate().map_T_base);
  }
}

TEST_P(HostileEvents, AnEmptyStreamIsNoEstimate) {
  const AnyLocalizer any = localizer();
  EXPECT_EQ(any.estimate().status, LocalizationStatus::kSearching);
  EXPECT_TRUE(any.estimate().hypotheses.empty());
}

INSTANTIATE_TEST_SUITE_P(Methods, HostileEvents, testing::ValuesIn(method_names()), [](const auto& method) {
  std::string name = method.param;
  std::erase(name, '-');
  return name;
});

}  // namespace
}  // namespace mstsl
