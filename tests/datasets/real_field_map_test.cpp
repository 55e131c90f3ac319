#include <vector>

#include <gtest/gtest.h>

#include "mstsl/datasets/aalto_robot.hpp"
#include "mstsl/datasets/cea_corridor.hpp"
#include "mstsl/magnetic/field_check.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"
#include "mstsl/magnetic/fingerprint_collector.hpp"

#include "test_support.hpp"

/// Maps of real surveys, held against another drive through the same place.
namespace mstsl::datasets {
namespace {

std::vector<Fingerprint> fingerprints_of(const std::vector<Log>& logs) {
  FingerprintCollector collector(logs.front().rig);
  for (const Log& log : logs) {
    if (&log != &logs.front()) collector.start_session(log.rig);
    log.play({[&](const SensorEvent& event) {
                if (const auto* field = std::get_if<FieldReading>(&event)) collector.observe(*field);
              },
              [&](const PoseReading& pose) { collector.observe(pose); }});
  }
  return collector.finish();
}

FieldCheck checked(const Dataset& dataset, std::size_t check) {
  const FieldMap map = test::must(build_field_map(fingerprints_of(dataset.surveys), &dataset.map));
  return check_field_map(map, fingerprints_of({dataset.checks[check]}));
}

void expect_honest(const FieldCheck& check) {
  EXPECT_EQ(check.without_value, 0U);
  for (int c = 0; c < 3; ++c) {
    EXPECT_GT(check.score.within_1_sigma(c), 0.5) << c;
    EXPECT_GT(check.score.within_2_sigma(c), 0.85) << c;
  }
}

// Limits: what the two passes themselves differ by (1.1-1.3 uT per axis where they lie near, README of the
// data), and half as much again.
TEST(RealFieldMap, CeaSurveyForetellsTheOtherPass) {
  MSTSL_REQUIRE_DATA("cea-corridor/floor_a_query.csv");
  CeaCorridorOptions options;
  options.runs.count = 1;
  options.robot.lidar.rate_hz = 0.0;
  const FieldCheck check =
      checked(test::must(cea_corridor(test::data_file("cea-corridor"), options, Random(1))), 0);
  EXPECT_GT(check.score.errors, 7000U);
  expect_honest(check);
  EXPECT_LT(check.score.rms_uT.maxCoeff(), 1.8);
}

// The floor repeats to 4.8 uT (vector, rms): 2.8 per axis.
TEST(RealFieldMap, AaltoDrivesForetellTheFifth) {
  MSTSL_REQUIRE_DATA("aalto-robot/5-mag.csv");
  const FieldCheck check = checked(test::must(aalto_robot(test::data_file("aalto-robot"))), 0);
  EXPECT_GT(check.score.errors, 400U);
  expect_honest(check);
  EXPECT_LT(check.score.rms_uT.matrix().norm(), 4.8);
}

/// A trolley of 35 uT goes along with the robot for 2 m in one of the drives.
TEST(RealFieldMap, APassingTrolleyOnAaltoIsTrustedLess) {
  MSTSL_REQUIRE_DATA("aalto-robot/5-mag.csv");
  const Dataset dataset = test::must(aalto_robot(test::data_file("aalto-robot")));
  std::vector<Fingerprint> survey = fingerprints_of(dataset.surveys);
  const std::size_t middle = survey.size() / 3;
  for (std::size_t i = middle; i < middle + 40; ++i) survey[i].field_uT += Eigen::Vector3d(20, -15, 25);
  const std::vector<Fingerprint> check = fingerprints_of({dataset.checks.front()});
  const auto error_uT = [&](bool heavy_tails) {
    FieldMapOptions options;
    options.heavy_tails = heavy_tails;
    options.analysis.outliers.least_uT = 1e6;  // not the test that drops single outliers
    const FieldMap map = test::must(build_field_map(survey, &dataset.map, options));
    if (heavy_tails) EXPECT_GT(map.hyperparameters.at("distrusted_fingerprints"), 20.0);
    return check_field_map(map, check).score.rms_uT.matrix().norm();
  };
  EXPECT_LT(error_uT(true), error_uT(false));
}

}  // namespace
}  // namespace mstsl::datasets
