#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/datasets/cea_corridor.hpp"
#include "mstsl/datasets/kaist.hpp"

#include "test_support.hpp"

namespace mstsl::datasets {
namespace {

/// The first true pose of a log, and the field there turned back into the map frame.
struct Start {
  PoseReading pose;
  Eigen::Vector3d map_field_uT;
};

Start start_of(const Log& log) {
  std::vector<PoseReading> truth;
  std::vector<FieldReading> readings;
  log.play({[&](const SensorEvent& event) {
              if (const auto* reading = std::get_if<FieldReading>(&event)) readings.push_back(*reading);
            },
            [&](const PoseReading& pose) { truth.push_back(pose); }});
  const Eigen::Matrix3d map_R_base =
      Eigen::AngleAxisd(truth.front().map_T_base.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return {truth.front(),
          map_R_base * log.rig.base_T_magnetometer.linear() * readings.front().sensor_field_uT};
}

/// Without a lidar, which these tests do not look at, logs play a hundred times faster.
template <typename Options>
Options without_lidar(std::size_t runs) {
  Options options;
  options.runs.count = runs;
  options.robot.lidar.rate_hz = 0.0;
  return options;
}

TEST(CeaCorridor, RunsStartAtARowOfTheQueryWithItsField) {
  MSTSL_REQUIRE_DATA("cea-corridor/floor_a_query.csv");
  const auto folder = test::data_file("cea-corridor");
  const auto query = test::must(read_cea_pass(folder / "floor_a_query.csv"));
  const Dataset dataset = test::must(cea_corridor(folder, without_lidar<CeaCorridorOptions>(8), Random(1)));
  ASSERT_EQ(dataset.runs.size(), 8U);
  for (const Log& run : dataset.runs) {
    const Start start = start_of(run);
    const auto row = std::find_if(query.begin(), query.end(), [&](const Fingerprint& r) {
      return (r.position_m - start.pose.map_T_base.position()).norm() < 1e-9;
    });
    ASSERT_NE(row, query.end());
    EXPECT_LT((start.map_field_uT - row->field_uT).norm(), 1e-9);
  }
}

TEST(CeaCorridor, MapIsFreeAlongBothPasses) {
  MSTSL_REQUIRE_DATA("cea-corridor/floor_a_survey.csv");
  const auto folder = test::data_file("cea-corridor");
  const Dataset dataset = test::must(cea_corridor(folder, without_lidar<CeaCorridorOptions>(1), Random(1)));
  for (const char* pass : {"floor_a_survey.csv", "floor_a_query.csv"})
    for (const Fingerprint& row : test::must(read_cea_pass(folder / pass)))
      ASSERT_EQ(state_at(dataset.map, row.position_m), CellState::kFree) << row.position_m.transpose();
}

TEST(CeaCorridor, OfSeveralFloorsIsRefused) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "pass.csv";
  std::ofstream(file) << "x_m,y_m,z_m,bx_uT,by_uT,bz_uT\n0,0,0,1,2,3\n0,1,3.5,1,2,3\n";
  const auto pass = read_cea_pass(file);
  ASSERT_FALSE(pass.ok());
  EXPECT_NE(pass.error().message().find("more than one floor"), std::string::npos);
}

TEST(CeaCorridor, SaysWhichFileIsAbsent) {
  const test::TemporaryFolder folder;
  const auto dataset = cea_corridor(folder.path(), {}, Random(1));
  ASSERT_FALSE(dataset.ok());
  EXPECT_NE(dataset.error().message().find("floor_a_survey.csv"), std::string::npos);
}

/// A corridor survey in one frame and a walk along it with a phone held askew.
struct AskewWalk {
  Eigen::Matrix3d survey_R_phone =
      Eigen::AngleAxisd(0.6, Eigen::Vector3d(1.0, 0.3, -0.5).normalized()).toRotationMatrix();
  std::vector<Fingerprint> survey, walk;

  AskewWalk() {
    for (int row = 0; row < 3; ++row)
      for (int i = 0; i <= 80; ++i) survey.push_back(at(0.5 * i, 0.6 * row));
    for (int i = 0; i <= 1950; ++i) {
      walk.push_back(at(0.02 * i, 0.6));
      walk.back().field_uT = survey_R_phone.transpose() * walk.back().field_uT;
    }
  }
  static Fingerprint at(double x_m, double y_m) {
    Fingerprint point;
    point.position_m = {x_m, y_m};
    point.field_uT = {20.0 * std::sin(0.3 * x_m), 15.0 * std::cos(0.2 * x_m),
                      -40.0 + 5.0 * std::sin(0.5 * x_m)};
    return point;
  }
};

TEST(WalkCalibration, FindsHowThePhoneWasHeldFromEitherHalf) {
  const AskewWalk known;
  for (const WalkHalf& half : test::must(calibrated_halves(known.walk, known.survey))) {
    EXPECT_LT((half.survey_R_phone - known.survey_R_phone).norm(), 0.01);
    EXPECT_LT(half.residual_uT.maxCoeff(),
              0.2);  // the lattice is linear between its points, the field is not
  }
}

TEST(WalkCalibration, TurnsNoHalfByAFitToItself) {
  AskewWalk known;
  for (std::size_t i = known.walk.size() / 2 + 1; i < known.walk.size(); ++i)
    known.walk[i].field_uT = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) * known.walk[i].field_uT;
  const auto halves = test::must(calibrated_halves(known.walk, known.survey));
  EXPECT_EQ(halves[0].survey_R_phone, halves[1].fit.to_R_from);
  EXPECT_EQ(halves[1].survey_R_phone, halves[0].fit.to_R_from);
  EXPECT_GT(halves[0].residual_uT.norm(), 10.0 * halves[0].fit.residual_rms.norm());
}

TEST(WalkCalibration, RefusesAWalkElsewhere) {
  AskewWalk known;
  for (Fingerprint& row : known.walk) row.position_m.y() += 100.0;
  EXPECT_FALSE(calibrated_halves(known.walk, known.survey).ok());
  EXPECT_FALSE(calibrated_halves({}, known.survey).ok());
}

TEST(KaistN17f, RunsHoldThePhonesOwnReadingsWhileTheyFaceAlongTheMap) {
  MSTSL_REQUIRE_DATA("kaist-n1-7f/batch.csv");
  const auto folder = test::data_file("kaist-n1-7f");
  const auto walk = test::must(read_kaist_walk(folder / "sjlee_testdata_N1_20180723.csv"));
  const Dataset dataset = test::must(kaist_n1_7f(folder, without_lidar<KaistOptions>(6), Random(1)));
  for (const Log& run : dataset.runs) {
    const Start start = start_of(run);
    const Eigen::Vector3d phone_uT = run.rig.base_T_magnetometer.linear().transpose() * start.map_field_uT;
    EXPECT_TRUE(std::any_of(walk.begin(), walk.end(), [&](const Fingerprint& row) {
      return (row.position_m - start.pose.map_T_base.position()).norm() < 1e-9 &&
             (row.field_uT - phone_uT).norm() < 1e-9;
    }));
  }
}

TEST(KaistN17f, SurveyHearsEveryPointOfTheLattice) {
  MSTSL_REQUIRE_DATA("kaist-n1-7f/batch.csv");
  const auto points = test::must(read_kaist_survey(test::data_file("kaist-n1-7f") / "batch.csv"));
  std::set<std::pair<double, double>> on_lanes;
  for (const auto& lane : lattice_lanes(points))
    for (const Fingerprint& point : lane) on_lanes.insert({point.position_m.x(), point.position_m.y()});
  EXPECT_EQ(on_lanes.size(), points.size());
}

TEST(KaistN17f, PhoneWasHeldLevelToAFewDegreesAndBothHalvesAgree) {
  MSTSL_REQUIRE_DATA("kaist-n1-7f/batch.csv");
  const auto folder = test::data_file("kaist-n1-7f");
  const auto halves =
      test::must(calibrated_halves(test::must(read_kaist_walk(folder / "sjlee_testdata_N1_20180723.csv")),
                                   test::must(read_kaist_survey(folder / "batch.csv"))));
  const Eigen::AngleAxisd apart(
      Eigen::Matrix3d(halves[0].survey_R_phone.transpose() * halves[1].survey_R_phone));
  EXPECT_LT(degrees(apart.angle()), 5.0);
  for (const WalkHalf& half : halves) {
    EXPECT_LT(degrees(Eigen::AngleAxisd(half.survey_R_phone).angle()), 20.0);
    EXPECT_LT(half.residual_uT.maxCoeff(), 6.0);
  }
}

}  // namespace
}  // namespace mstsl::datasets
