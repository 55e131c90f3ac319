#include "mstsl/datasets/dataset_writer.hpp"

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/io/map_server.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/io/truth.hpp"

#include "test_support.hpp"

namespace mstsl::datasets {
namespace {

/// A log of ten odometry readings and ten of the field.
Log small_log() {
  Log log;
  log.rig.base_T_magnetometer.translation() = Eigen::Vector3d(0.1, 0.2, 0.7);
  log.play = [](const sim::DriveSinks& sinks) {
    for (int i = 0; i < 10; ++i) {
      const Stamp stamp = Stamp::from_parts(100, 0) + 0.1 * i;
      const Pose2 pose = {0.05 * i, 0.0, 0.25};
      if (sinks.truth) sinks.truth({stamp, pose});
      if (sinks.event) sinks.event(OdometryReading{stamp, pose});
      if (sinks.event) sinks.event(FieldReading{stamp + 0.01, {20.0 + i, -1.0, -40.0}});
    }
  };
  return log;
}

Dataset small_dataset(std::size_t surveys, std::size_t runs, std::size_t checks = 0) {
  GridGeometry geometry;
  geometry.columns = geometry.rows = 20;
  return {OccupancyGrid(geometry, CellState::kFree), std::vector<Log>(surveys, small_log()),
          std::vector<Log>(runs, small_log()), "all of it is made up\n",
          std::vector<Log>(checks, small_log())};
}

std::vector<SensorEvent> played(const std::filesystem::path& file, const std::string& pose_topic) {
  io::PlayOptions options;
  options.topics = {.scan = "", .odometry = "/odom", .imu = "", .pose = pose_topic};
  std::vector<SensorEvent> events;
  test::must(
      io::play({file}, options, {}, [&](const SensorEvent& event) { return events.push_back(event), true; }));
  return events;
}

template <typename Reading>
std::size_t count_of(const std::vector<SensorEvent>& events) {
  std::size_t count = 0;
  for (const SensorEvent& event : events) count += std::holds_alternative<Reading>(event) ? 1 : 0;
  return count;
}

std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

TEST(DatasetWriter, WritesMapLogsTruthAndWhatIsReal) {
  const test::TemporaryFolder folder;
  const auto out = folder.path() / "a" / "b";
  test::must(write_dataset(small_dataset(1, 2), out));
  EXPECT_EQ(names_in(out),
            (std::set<std::string>{"README.txt", "map.pgm", "map.yaml", "run_00.mcap", "run_01.mcap",
                                   "survey_00.mcap", "truth_00.csv", "truth_01.csv"}));
  EXPECT_EQ(test::must(io::read_map(out / "map.yaml")).geometry().columns, 20);
}

TEST(DatasetWriter, PutsTheTruthIntoSurveysAndNeverIntoRuns) {
  const test::TemporaryFolder folder;
  test::must(write_dataset(small_dataset(1, 1), folder.path()));
  const auto survey = played(folder.path() / "survey_00.mcap", "/ground_truth");
  EXPECT_EQ(count_of<PoseReading>(survey), 10U);
  EXPECT_EQ(count_of<FieldReading>(survey), 10U);
  io::PlayOptions with_pose;
  with_pose.topics.pose = "/ground_truth";
  EXPECT_FALSE(
      io::play({folder.path() / "run_00.mcap"}, with_pose, {}, [](const SensorEvent&) { return true; }).ok());
  const auto run = played(folder.path() / "run_00.mcap", "");
  EXPECT_EQ(count_of<OdometryReading>(run), 10U);
  const auto truth = test::must(io::read_truth(folder.path() / "truth_00.csv"));
  ASSERT_EQ(truth.size(), 10U);
  EXPECT_NEAR(truth.back().map_T_base.x, 0.45, 1e-9);
}

TEST(DatasetWriter, PutsTheTruthIntoChecks) {
  const test::TemporaryFolder folder;
  test::must(write_dataset(small_dataset(0, 0, 1), folder.path()));
  EXPECT_EQ(count_of<PoseReading>(played(folder.path() / "check_00.mcap", "/ground_truth")), 10U);
  const auto fewer = write_dataset(small_dataset(0, 0, 0), folder.path());
  ASSERT_FALSE(fewer.ok());
  EXPECT_NE(fewer.error().message().find("check_00.mcap"), std::string::npos) << fewer.error().message();
}

TEST(DatasetWriter, KeepsTheFieldAndItsMounting) {
  const test::TemporaryFolder folder;
  test::must(write_dataset(small_dataset(0, 1), folder.path()));
  Rig rig;
  std::vector<FieldReading> readings;
  io::PlayOptions options;
  options.topics.scan.clear();
  options.topics.imu.clear();
  test::must(io::play(
      {folder.path() / "run_00.mcap"}, options, [&](const io::RecordingHeader& h) { rig = h.rig; },
      [&](const SensorEvent& event) {
        if (const auto* field = std::get_if<FieldReading>(&event)) readings.push_back(*field);
        return true;
      }));
  EXPECT_NEAR(rig.base_T_magnetometer.translation().z(), 0.7, 1e-9);
  ASSERT_EQ(readings.size(), 10U);
  EXPECT_NEAR(readings[3].sensor_field_uT.x(), 23.0, 1e-9);
}

TEST(DatasetWriter, ReplacesItsOwnLogsButLeavesNoOthersBeside) {
  const test::TemporaryFolder folder;
  test::must(write_dataset(small_dataset(1, 3), folder.path()));
  test::must(write_dataset(small_dataset(1, 3), folder.path()));
  const auto fewer = write_dataset(small_dataset(1, 2), folder.path());
  ASSERT_FALSE(fewer.ok());
  EXPECT_NE(fewer.error().message().find("_02."), std::string::npos) << fewer.error().message();
  std::ofstream(folder.path() / "notes.txt") << "mine";
  test::must(write_dataset(small_dataset(1, 3), folder.path()));
}

TEST(DatasetWriter, StopsWhenAsked) {
  const test::TemporaryFolder folder;
  const auto stopped =
      write_dataset(small_dataset(1, 3), folder.path(), [](double share) { return share < 0.5; });
  ASSERT_FALSE(stopped.ok());
  EXPECT_NE(stopped.error().message().find("2 of 4"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "run_01.mcap"));
}

TEST(DatasetWriter, SaysWhyAFolderCannotBeMade) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "";
  const auto written = write_dataset(small_dataset(1, 1), folder.path() / "file" / "out");
  ASSERT_FALSE(written.ok());
  EXPECT_NE(written.error().message().find("cannot make the folder"), std::string::npos);
}

}  // namespace
}  // namespace mstsl::datasets
