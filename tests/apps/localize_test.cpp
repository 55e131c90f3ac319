#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "mstsl/io/estimates.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/recording_writer.hpp"
#include "mstsl/io/truth.hpp"
#include "mstsl/io/tum.hpp"

#include "../localize/hand_made_world.hpp"

/// `mstsl localize` and `mstsl evaluate` as a user meets them.
namespace mstsl {
namespace {

namespace fs = std::filesystem;
using test::must;

struct Printed {
  int exit_status = -1;
  std::string text;  ///< stdout and stderr together
};

Printed run_app(const std::string& arguments) {
  const std::string command = std::string(MSTSL_APP) + " " + arguments + " 2>&1";
  Printed printed;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return printed;
  char piece[4096];
  for (std::size_t got; (got = std::fread(piece, 1, sizeof piece, pipe)) > 0;)
    printed.text.append(piece, got);
  const int status = pclose(pipe);
  printed.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return printed;
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return (std::ostringstream() << stream.rdbuf()).str();
}

/// The hand-made building's files and one drive through it, made once for all tests.
class Files {
 public:
  static const Files& get() {
    static const Files files;
    return files;
  }
  fs::path path(const std::string& name) const { return folder_.path() / name; }

 private:
  Files() {
    const test::HandMadeWorld world;
    must(io::write_map(world.map, path("map.yaml")));
    must(io::write_field_map(world.field_map(), path("field.nc")));
    must(io::write_field_map(test::HandMadeWorld(Pose2{13.0, 4.0, 0.3}).field_map(), path("elsewhere.nc")));
    const test::Drive drive{{3.0, 1.0, radians(30)}, radians(-30), 0.0, 8.0};
    const Rig rig;
    const auto events = test::events_of(world, drive, rig);
    write_log("run.mcap", rig, events);
    write_log("short.mcap", rig, {events.begin(), events.begin() + 60});
    write_log("empty.mcap", rig, {});
    std::vector<PoseReading> truth;
    const Trajectory poses = test::driven(drive);
    for (std::size_t i = 0; i < poses.size(); ++i) truth.push_back({poses[i].stamp, poses[i].pose});
    must(io::write_truth(truth, path("truth.csv")));
  }

  void write_log(const std::string& name, const Rig& rig, const std::vector<SensorEvent>& events) const {
    auto writer = must(io::RecordingWriter::open(path(name), rig, {}));
    for (const SensorEvent& event : events) must(writer.write(event));
    must(writer.close());
  }

  test::TemporaryFolder folder_;
};

std::string localize(const std::string& log, const std::string& output, const std::string& more = "") {
  const Files& files = Files::get();
  return "localize --map " + files.path("map.yaml").string() + " --field " + files.path("field.nc").string() +
         " -o " + files.path(output).string() + " " + more + " " + files.path(log).string();
}

TEST(LocalizeCommand, FindsTheRobotAndWritesWhatItFound) {
  const Files& files = Files::get();
  const Printed printed =
      run_app(localize("run.mcap", "found.jsonl", "--json --tum " + files.path("found.tum").string()));
  ASSERT_EQ(printed.exit_status, 0) << printed.text;
  const auto summary = nlohmann::json::parse(printed.text);
  EXPECT_EQ(summary.at("status"), "localized");
  EXPECT_GT(summary.at("distance_to_fix_m"), 0.0);
  const io::EstimatesFile estimates = must(io::read_estimates(files.path("found.jsonl")));
  ASSERT_TRUE(estimates.summary);
  EXPECT_EQ(estimates.estimates.back().status, LocalizationStatus::kLocalized);
  EXPECT_EQ(static_cast<std::int64_t>(estimates.estimates.size()),
            std::get<std::int64_t>(estimates.summary->at("estimates")));
  EXPECT_FALSE(must(io::read_tum(files.path("found.tum"))).empty());
}

TEST(LocalizeCommand, WritesTheSameBytesEachTime) {
  const Files& files = Files::get();
  ASSERT_EQ(run_app(localize("run.mcap", "one.jsonl", "--quiet --threads 1")).exit_status, 0);
  ASSERT_EQ(run_app(localize("run.mcap", "two.jsonl", "--quiet --threads 2")).exit_status, 0);
  EXPECT_EQ(content_of(files.path("one.jsonl")), content_of(files.path("two.jsonl")));
}

TEST(LocalizeCommand, EndsWithStatus3WithoutAFix) {
  const Printed printed = run_app(localize("short.mcap", "short.jsonl"));
  EXPECT_EQ(printed.exit_status, 3) << printed.text;
  EXPECT_NE(printed.text.find("no pose was found"), std::string::npos) << printed.text;
}

TEST(LocalizeCommand, RefusesAFieldMapOfAnotherPlace) {
  const Files& files = Files::get();
  const Printed printed = run_app("localize --map " + files.path("map.yaml").string() + " --field " +
                                  files.path("elsewhere.nc").string() + " -o " +
                                  files.path("no.jsonl").string() + " " + files.path("run.mcap").string());
  EXPECT_EQ(printed.exit_status, 1);
  EXPECT_NE(printed.text.find("elsewhere.nc"), std::string::npos) << printed.text;
  EXPECT_NE(printed.text.find("of another place"), std::string::npos) << printed.text;
  EXPECT_FALSE(fs::exists(files.path("no.jsonl")));
}

TEST(LocalizeCommand, NamesTheTopicThatIsMissingAndThoseThatAreThere) {
  const Printed printed = run_app(localize("run.mcap", "topic.jsonl", "--scan-topic /front_scan"));
  EXPECT_EQ(printed.exit_status, 1);
  EXPECT_NE(printed.text.find("/front_scan"), std::string::npos) << printed.text;
  EXPECT_NE(printed.text.find("/imu/mag"), std::string::npos) << printed.text;
}

TEST(LocalizeCommand, SaysWhatIsWrongInOneLine) {
  for (const std::string& log :
       {std::string("empty.mcap"), std::string("absent.mcap"), std::string("map.yaml")}) {
    const Printed printed = run_app(localize(log, "bad.jsonl"));
    EXPECT_EQ(printed.exit_status, 1) << log;
    EXPECT_EQ(std::count(printed.text.begin(), printed.text.end(), '\n'), 1) << printed.text;
    EXPECT_NE(printed.text.find(log), std::string::npos) << printed.text;
  }
}

TEST(LocalizeCommand, WrongUsageIsStatus2) {
  EXPECT_EQ(run_app("localize").exit_status, 2);
  EXPECT_EQ(run_app(localize("run.mcap", "x.jsonl", "-k 0")).exit_status, 2);
  EXPECT_EQ(run_app(localize("run.mcap", "x.jsonl", "--method guess")).exit_status, 2);
}

TEST(EvaluateCommand, JudgesWhatLocalizeWrote) {
  const Files& files = Files::get();
  ASSERT_EQ(run_app(localize("run.mcap", "judged.jsonl", "--quiet")).exit_status, 0);
  const std::string estimates = files.path("judged.jsonl").string(), truth = files.path("truth.csv").string();
  const Printed json = run_app("evaluate --json --truth " + truth + " " + estimates);
  ASSERT_EQ(json.exit_status, 0) << json.text;
  const auto summary = nlohmann::json::parse(json.text);
  EXPECT_EQ(summary.at("runs"), 1);
  EXPECT_EQ(summary.at("success").at("hits"), 1);
  EXPECT_EQ(summary.at("initialised").at("hits"), 1);
  const Printed table =
      run_app("evaluate --truth " + truth + " --truth " + truth + " " + estimates + " " + estimates);
  EXPECT_EQ(table.exit_status, 0) << table.text;
  EXPECT_NE(table.text.find("2 runs"), std::string::npos) << table.text;
}

TEST(EvaluateCommand, RefusesTruthsThatDoNotPairUp) {
  const Files& files = Files::get();
  const std::string truth = files.path("truth.csv").string();
  const Printed printed =
      run_app("evaluate --truth " + truth + " --truth " + truth + " a.jsonl b.jsonl c.jsonl");
  EXPECT_EQ(printed.exit_status, 1);
  EXPECT_NE(printed.text.find("2 truths for 3 files"), std::string::npos) << printed.text;
}

}  // namespace
}  // namespace mstsl
