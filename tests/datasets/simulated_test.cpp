#include "mstsl/datasets/simulated.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/datasets/dataset_writer.hpp"

#include "test_support.hpp"

namespace mstsl::datasets {
namespace {

using test::must;

/// A small building, quickly surveyed, with a lidar of few beams.
sim::World building() {
  sim::WorldOptions options;
  options.size_m = {32, 18};
  return must(sim::make_world("corridor", options, Random(1)));
}

SimulatedOptions quick() {
  SimulatedOptions options;
  options.survey.lane_spacing_m = 2.0;
  options.survey_scan_hz = 0.5;
  options.runs = 4;
  options.run.length_m = 8.0;
  options.robot.lidar.beams = 271;
  options.robot.lidar.rate_hz = 2.0;
  return options;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<PoseReading> truth_of(const Log& log) {
  std::vector<PoseReading> truth;
  log.play({{}, [&](const PoseReading& pose) { truth.push_back(pose); }});
  return truth;
}

TEST(Simulated, HasAMapSurveysAndRuns) {
  const Dataset dataset = must(simulated(building(), quick(), Random(2)));
  EXPECT_GT(count(dataset.map, CellState::kFree), 10'000u);
  EXPECT_GE(dataset.surveys.size(), 1u);
  EXPECT_EQ(dataset.runs.size(), 4u);
  EXPECT_NE(dataset.provenance.find("simulated"), std::string::npos);
  for (const Log& run : dataset.runs)
    for (const PoseReading& pose : truth_of(run))
      EXPECT_EQ(state_at(dataset.map, pose.map_T_base.position()), CellState::kFree);
}

TEST(Simulated, WritesTheSameBytesForTheSameSeed) {
  const test::TemporaryFolder first, second;
  for (const auto* folder : {&first, &second})
    must(write_dataset(must(simulated(building(), quick(), Random(2))), folder->path()));
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(first.path())) {
    ++files;
    EXPECT_TRUE(bytes_of(entry.path()) == bytes_of(second.path() / entry.path().filename())) << entry.path();
  }
  EXPECT_GE(files, 3 + 1 + 4 + 4);
}

TEST(Simulated, BeginsRunsWithATurnThatAlignsTheRobotWithTheWalls) {
  const Dataset dataset = must(simulated(building(), quick(), Random(2)));
  for (const Log& run : dataset.runs) {
    const std::vector<PoseReading> truth = truth_of(run);
    const Pose2 start = truth.front().map_T_base;
    // Standing after the commanded turn: the last pose before it moves away or turns on.
    double aligned = start.yaw;
    double best = 0.0, stood_s = 0.0;
    for (std::size_t i = 1; i < truth.size() && distance(truth[i].map_T_base, start) < 0.01; ++i) {
      stood_s = truth[i].map_T_base.yaw == truth[i - 1].map_T_base.yaw ? stood_s + 0.02 : 0.0;
      if (stood_s > 0.9) aligned = truth[i].map_T_base.yaw, best = stood_s;
    }
    EXPECT_GT(best, 0.9);
    EXPECT_NEAR(degrees(std::remainder(aligned, radians(90))), 0.0, 3.0);
  }
}

TEST(Simulated, LeavesTheHeadingRandomWithoutTheTurn) {
  SimulatedOptions options = quick();
  options.turn_to_wall = false;
  int askew = 0;
  for (const Log& run : must(simulated(building(), options, Random(2))).runs)
    askew += std::abs(degrees(std::remainder(truth_of(run).front().map_T_base.yaw, radians(90)))) > 3.0;
  EXPECT_GE(askew, 2);
}

TEST(Simulated, DrawsEachLogsErrorsAnew) {
  const Dataset dataset = must(simulated(building(), quick(), Random(2)));
  std::vector<Eigen::Vector3d> first;
  for (const Log& run : dataset.runs) {
    bool seen = false;
    run.play({[&](const SensorEvent& event) {
                const auto* field = std::get_if<FieldReading>(&event);
                if (field && !seen) first.push_back(field->sensor_field_uT), seen = true;
              },
              {}});
  }
  ASSERT_EQ(first.size(), 4u);
  EXPECT_NE(first[0], first[1]);
  EXPECT_NE(first[1], first[2]);
}

TEST(Simulated, SaysWhatCannotBeSurveyedOrDriven) {
  SimulatedOptions few = quick(), wide = quick();
  few.survey.fingerprints = 10;
  wide.run.path.clearance_m = 5.0;  // no lane has room for such a robot
  EXPECT_FALSE(simulated(building(), few, Random(2)));
  EXPECT_FALSE(simulated(building(), wide, Random(2)));
}

}  // namespace
}  // namespace mstsl::datasets
