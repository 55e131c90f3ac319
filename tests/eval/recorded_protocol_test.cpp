#include "mstsl/eval/recorded_protocol.hpp"

#include <memory>

#include <gtest/gtest.h>

#include "mstsl/sim/occupancy_map.hpp"
#include "mstsl/sim/run.hpp"
#include "mstsl/sim/survey.hpp"
#include "mstsl/sim/world.hpp"

#include "test_support.hpp"

namespace mstsl {
namespace {

using test::must;

/// A simulated corridor loop in the place of a recording: one survey, three runs.
RecordedCase corridor() {
  const Random random(51);
  sim::WorldOptions size;
  size.size_m = {30.0, 16.0};
  const auto world =
      std::make_shared<const sim::World>(must(sim::make_world("corridor", size, random.fork(0))));
  RecordedCase recorded{"corridor", sim::occupancy_map(*world), {}, {}};
  const auto log = [&](const sim::Route& route, double scan_hz, std::uint64_t stream) -> RecordedLog {
    sim::RobotOptions robot;
    robot.lidar.rate_hz = scan_hz;
    return {robot.rig, [=, drive = random.fork(stream)](const sim::DriveSinks& sinks) {
              sim::drive(*world, robot, route, Stamp{}, drive, sinks);
            }};
  };
  for (const sim::Route& route : must(sim::survey_routes(*world, {.lane_spacing_m = 1.0})))
    recorded.surveys.push_back(log(route, 0.0, 1));
  for (std::uint64_t run = 0; run < 3; ++run)
    recorded.runs.push_back(
        log(must(sim::random_run(*world, {.length_m = 8.0}, random.fork(10 + run))), 10.0, 20 + run));
  return recorded;
}

/// A field map that is quickly made.
RecordedOptions quick(std::vector<std::string> methods) {
  RecordedOptions options;
  options.methods = std::move(methods);
  options.field.resolution_m = 0.2;
  options.field.analysis.kernel = KernelChoice::kSquaredExponential;
  return options;
}

TEST(RecordedProtocol, PlaysEveryRunToAllMethodsTheSameAtAnyNumberOfThreads) {
  const RecordedCase recorded = corridor();
  RecordedOptions options = quick({"joint", "global-scan"});
  options.threads = {1};
  const RecordedOutcome one = must(run_recorded_case(recorded, options));
  options.threads = {2};
  const RecordedOutcome two = must(run_recorded_case(recorded, options));
  ASSERT_EQ(one.results.size(), 2U);
  EXPECT_EQ(one.results[0].method, "joint");
  for (std::size_t m = 0; m < 2; ++m) {
    ASSERT_EQ(one.results[m].runs.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const RunEvaluation &a = one.results[m].runs[i], &b = two.results[m].runs[i];
      EXPECT_EQ(a.estimates, b.estimates);
      EXPECT_EQ(a.correct_distance_m, b.correct_distance_m);
      ASSERT_EQ(a.answers.size(), b.answers.size());
      for (std::size_t k = 0; k < a.answers.size(); ++k)
        EXPECT_EQ(a.answers[k].error.position_m, b.answers[k].error.position_m);
    }
  }
  for (const RunEvaluation& run : one.results[0].runs) EXPECT_TRUE(run.succeeded());
  EXPECT_EQ(one.trace.methods.size(), 2U);
  EXPECT_EQ(one.trace.methods[0].estimates.size(), one.results[0].runs[0].estimates);
  EXPECT_GT(one.trace.scans.size(), 20U);
  EXPECT_TRUE(one.trace.place);
}

TEST(RecordedProtocol, SaysWhatIsMissingAndEndsWhenAsked) {
  RecordedCase recorded = corridor();
  EXPECT_FALSE(run_recorded_case(recorded, quick({"guess"})));
  RecordedOptions options = quick({"global-scan"});
  options.progress = [](double) { return false; };
  const auto ended = run_recorded_case(recorded, options);
  ASSERT_FALSE(ended);
  EXPECT_NE(ended.error().message().find("interrupted"), std::string::npos);
  recorded.runs.clear();
  EXPECT_NE(run_recorded_case(recorded, {}).error().message().find("no run"), std::string::npos);
}

}  // namespace
}  // namespace mstsl
