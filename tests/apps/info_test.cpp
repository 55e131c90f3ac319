#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mstsl/io/estimates.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/recording_writer.hpp"
#include "mstsl/io/truth.hpp"

#include "run_app.hpp"
#include "test_support.hpp"

/// `mstsl info` as a user meets it: the program is run, and what it prints is read.
namespace mstsl {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::must;

using test::Printed;

Printed run_info(const fs::path& file, const std::string& options = "") {
  return test::run_app("info " + options + " '" + file.string() + "'");
}

json info(const fs::path& file) {
  const Printed printed = run_info(file, "--json");
  EXPECT_EQ(printed.exit_status, 0) << printed.text;
  return json::parse(printed.text);
}

class Info : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(Info, TellsOfAMap) {
  OccupancyGrid grid({0.5, 20, 10, Pose2{-1.0, 2.0, 0.0}}, CellState::kFree);
  grid[{3, 4}] = CellState::kOccupied;
  grid[{4, 4}] = CellState::kUnknown;
  must(io::write_map(grid, path("map.yaml")));
  const json map = info(path("map.yaml"));
  EXPECT_EQ(map["kind"], "occupancy map");
  EXPECT_EQ(map["free_m2"], 198 * 0.25);
  EXPECT_EQ(map["occupied_m2"], 0.25);
  EXPECT_EQ(map["width_m"], 10.0);
  EXPECT_EQ(map["origin"]["y_m"], 2.0);
  const std::string text = run_info(path("map.yaml")).text;
  EXPECT_NE(text.find("occupancy map\n"), std::string::npos) << text;
  EXPECT_NE(text.find("49.5 m2\n"), std::string::npos) << text;
  const Printed image = run_info(path("map.pgm"));
  EXPECT_EQ(image.exit_status, 1);
  EXPECT_NE(image.text.find("ask about the yaml"), std::string::npos);
}

TEST_F(Info, TellsOfAFieldMapWhateverItsName) {
  FieldMap field;
  field.geometry = {0.05, 4, 3, Pose2{}};
  field.mean_uT.assign(12, Eigen::Vector3f(3.0F, 0.0F, 4.0F));
  field.variance_uT2.assign(12, Eigen::Vector3f::Constant(4.0F));
  field.supported = {1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0};
  field.hyperparameters = {{"length_scale_x_m", 0.8}};
  field.provenance = {"survey.mcap"};
  must(io::write_field_map(field, path("anything.dat")));
  const json description = info(path("anything.dat"));
  EXPECT_EQ(description["model"], "gpr");
  EXPECT_EQ(description["cells_supported_percent"], 50.0);
  EXPECT_EQ(description["hyperparameters"]["length_scale_x_m"], 0.8);
  EXPECT_EQ(description["field_of_supported_cells"][3]["mean_uT"], 5.0);
  EXPECT_EQ(description["field_of_supported_cells"][4]["mean_uT"], 2.0);
  const std::string text = run_info(path("anything.dat")).text;
  EXPECT_NE(text.find("|B|"), std::string::npos) << text;
  EXPECT_NE(text.find("    survey.mcap\n"), std::string::npos) << text;
}

TEST_F(Info, TellsOfEstimatesAndOfTrueposes) {
  auto writer = must(io::EstimatesWriter::open(path("e.jsonl")));
  Estimate estimate;
  must(writer.write(estimate));
  estimate.stamp = {2'000'000'000};
  estimate.travelled_m = 1.5;
  estimate.status = LocalizationStatus::kLocalized;
  estimate.map_T_base = Pose2{1, 2, 0.5};
  must(writer.write(estimate));
  must(writer.close({{"method", "two-step"}}));
  const json run = info(path("e.jsonl"));
  EXPECT_EQ(run["scans"], 2);
  EXPECT_EQ(run["scans_localized"], 1);
  EXPECT_EQ(run["first_fix_after_m"], 1.5);
  EXPECT_EQ(run["last_pose"]["x_m"], 1.0);
  EXPECT_EQ(run["summary"]["method"], "two-step");
  must(io::write_truth({{{0}, {0, 0, 0}}, {{1'000'000'000}, {3, 4, 0}}}, path("truth.csv")));
  EXPECT_EQ(info(path("truth.csv"))["path_m"], 5.0);
}

TEST_F(Info, TellsOfALogAndCountsWhatIsWrong) {
  auto writer = must(io::RecordingWriter::open(path("log.mcap"), Rig{}, io::Topics{}));
  for (int i = 0; i < 101; ++i) {
    const Stamp stamp{1'000'000'000 + std::int64_t{10'000'000} * i};
    must(writer.write(OdometryReading{stamp, Pose2{0.01 * i, 0.0, 0.0}}));
    must(writer.write(FieldReading{stamp, {20.0, 0.0, i == 50 ? std::nan("") : -40.0}}));
  }
  must(writer.close());
  const json log = info(path("log.mcap"));
  EXPECT_EQ(log["kind"], "MCAP");
  EXPECT_NEAR(log["duration_s"].get<double>(), 1.0, 1e-9);
  bool found = false;
  for (const json& topic : log["topics"])
    if (topic["topic"] == "/imu/mag") {
      found = true;
      EXPECT_EQ(topic["messages"], 101);
      EXPECT_EQ(topic["type"], "sensor_msgs/MagneticField");
      EXPECT_NEAR(topic["rate_Hz"].get<double>(), 101.0, 0.1);
    }
  EXPECT_TRUE(found) << log;
  ASSERT_EQ(log["problems"].size(), 1u) << log;
  EXPECT_EQ(log["problems"][0]["count"], 1);
  const std::string text = run_info(path("log.mcap")).text;
  EXPECT_NE(text.find("rate (Hz)"), std::string::npos) << text;
}

TEST_F(Info, AnswersToAnyOtherFileWithOneSentence) {
  const auto put = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  };
  for (const fs::path& file : {path("absent"), put("empty", ""), put("words", "some words\n"),
                               put("cut.mcap", "\x89MCAP0\r\n"), put("cut.nc", "\x89HDF\r\n\x1a\n"),
                               put("odd.yaml", "image: [1\n"), put("odd.jsonl", "{\"t\": 1}\n"), path(".")}) {
    const Printed printed = run_info(file);
    EXPECT_EQ(printed.exit_status, 1) << file << ": " << printed.text;
    EXPECT_TRUE(printed.text.starts_with("mstsl: ")) << printed.text;
    EXPECT_EQ(printed.text.find('\n'), printed.text.size() - 1) << printed.text;
  }
  EXPECT_EQ(run_info("", "").exit_status, 1);
}

}  // namespace
}  // namespace mstsl
