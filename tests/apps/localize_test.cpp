#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mstsl/io/estimates.hpp"
#include "mstsl/io/tum.hpp"

#include "run_app.hpp"
#include "site.hpp"

/// `mstsl localize` and `mstsl evaluate` as a user meets them.
namespace mstsl {
namespace {

namespace fs = std::filesystem;
using test::must;
using test::Printed;
using test::run_app;
using test::Site;

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return (std::ostringstream() << stream.rdbuf()).str();
}

std::string localize(const std::string& log, const std::string& output, const std::string& more = "") {
  return Site::get().localize(log, output, more);
}

TEST(LocalizeCommand, FindsTheRobotAndWritesWhatItFound) {
  const Site& files = Site::get();
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
  const Site& files = Site::get();
  ASSERT_EQ(run_app(localize("run.mcap", "one.jsonl", "--quiet --threads 1")).exit_status, 0);
  ASSERT_EQ(run_app(localize("run.mcap", "two.jsonl", "--quiet --threads 2")).exit_status, 0);
  EXPECT_EQ(content_of(files.path("one.jsonl")), content_of(files.path("two.jsonl")));
}

TEST(LocalizeCommand, DrawsTheRun) {
  const Site& files = Site::get();
  const std::string picture = files.path("run.svg").string();
  ASSERT_EQ(run_app(localize("run.mcap", "drawn.jsonl", "--quiet --picture " + picture)).exit_status, 0);
  const std::string alone = content_of(picture), truth = " --truth " + files.path("truth.csv").string();
  EXPECT_EQ(alone.find("<?xml"), 0u);
  ASSERT_EQ(run_app(localize("run.mcap", "drawn.jsonl", "--picture " + picture + truth)).exit_status, 0);
  EXPECT_GT(content_of(picture).size(), alone.size() + 1000) << "the true way is drawn too";
  const Printed wrong = run_app(localize("run.mcap", "drawn.jsonl", "--picture " + picture + ".gif"));
  EXPECT_EQ(wrong.exit_status, 1);
  EXPECT_TRUE(wrong.says(".gif")) << wrong.text;
}

TEST(LocalizeCommand, DrawsARunWithoutAFixToo) {
  const Site& files = Site::get();
  const std::string picture = files.path("short.svg").string();
  EXPECT_EQ(run_app(localize("short.mcap", "short_drawn.jsonl", "--picture " + picture)).exit_status, 3);
  EXPECT_EQ(content_of(picture).find("<?xml"), 0u);
}

TEST(LocalizeCommand, EndsWithStatus3WithoutAFix) {
  const Printed printed = run_app(localize("short.mcap", "short.jsonl"));
  EXPECT_EQ(printed.exit_status, 3) << printed.text;
  EXPECT_NE(printed.text.find("no pose was found"), std::string::npos) << printed.text;
}

TEST(LocalizeCommand, RefusesAFieldMapOfAnotherPlace) {
  const Site& files = Site::get();
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
  const Site& files = Site::get();
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
  const Site& files = Site::get();
  const std::string truth = files.path("truth.csv").string();
  const Printed printed =
      run_app("evaluate --truth " + truth + " --truth " + truth + " a.jsonl b.jsonl c.jsonl");
  EXPECT_EQ(printed.exit_status, 1);
  EXPECT_NE(printed.text.find("2 truths for 3 files"), std::string::npos) << printed.text;
}

}  // namespace
}  // namespace mstsl
