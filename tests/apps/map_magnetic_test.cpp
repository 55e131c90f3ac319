#include <filesystem>
#include <string>
#include <variant>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mstsl/io/recording.hpp"

#include "run_app.hpp"
#include "test_support.hpp"

namespace mstsl::test {
namespace {

/// A small simulated building with a survey, made once for all tests.
class Surveyed {
 public:
  static const Surveyed& get() {
    static const Surveyed surveyed;
    return surveyed;
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string map(const std::string& more) const {
    return "map magnetic --map " + path("map.yaml") + " --pose-topic /ground_truth --resolution 0.2 -o " +
           path("field.nc") + " " + more;
  }

 private:
  Surveyed() {
    const Printed made = run_app(
        "simulate --world corridor --size 30,16 --lane-spacing 3 --survey-scan-hz 0 --runs 0 --quiet -o " +
        folder_.path().string());
    if (made.exit_status != 0) throw std::runtime_error(made.text);
    std::filesystem::copy_file(path("survey_00.mcap"), path("another.mcap"));  // as if driven again
  }
  TemporaryFolder folder_;
};

TEST(MapMagnetic, SaysHowWellOtherDrivesAreForetold) {
  const Surveyed& site = Surveyed::get();
  const Printed made =
      run_app(site.map("--json " + site.path("survey_00.mcap") + " --check " + site.path("another.mcap")));
  ASSERT_EQ(made.exit_status, 0) << made.text;
  const auto report = nlohmann::json::parse(made.text.substr(made.text.find('{')));
  ASSERT_EQ(report.at("checks").size(), 1U);
  const auto& check = report.at("checks")[0];
  EXPECT_EQ(check.at("log"), "another.mcap");
  EXPECT_GT(check.at("fingerprints").get<int>() + check.at("off_the_map").get<int>(), 100);
  EXPECT_TRUE(report.at("kernel").at("chosen") == "harmonic" ||
              report.at("kernel").at("chosen") == "squared-exponential");
  EXPECT_TRUE(report.at("kernel").contains("log_density_gain"));
}

TEST(MapMagnetic, KernelIsAsAskedFor) {
  const Surveyed& site = Surveyed::get();
  for (const char* kernel : {"se", "harmonic"}) {
    const Printed made =
        run_app(site.map(std::string("--json --kernel ") + kernel + " " + site.path("survey_00.mcap")));
    ASSERT_EQ(made.exit_status, 0) << made.text;
    const auto report = nlohmann::json::parse(made.text.substr(made.text.find('{')));
    EXPECT_EQ(report.at("kernel").at("chosen"),
              kernel == std::string("se") ? "squared-exponential" : "harmonic");
  }
  EXPECT_EQ(run_app(site.map("--kernel linear " + site.path("survey_00.mcap"))).exit_status, 2);
}

TEST(MapMagnetic, ADriveOfTheSurveyDoesNotCheckItself) {
  const Surveyed& site = Surveyed::get();
  const std::string log = site.path("survey_00.mcap");
  const Printed made = run_app(site.map(log + " --check " + log));
  EXPECT_EQ(made.exit_status, 1);
  EXPECT_TRUE(made.says("give --check another drive")) << made.text;
  EXPECT_FALSE(run_app(site.map(log + " --check " + site.path("absent.mcap"))).exit_status == 0);
}

/// Where the robot was when a log began.
std::string first_pose(const std::string& log) {
  std::string text;
  const auto played = io::play(
      {log}, {.topics = {.pose = "/ground_truth"}}, [](const io::RecordingHeader&) {},
      [&](const SensorEvent& event) {
        if (const auto* pose = std::get_if<PoseReading>(&event)) {
          const Pose2& p = pose->map_T_base;
          text = fmt::format("{:.2f},{:.2f},{:.2f}", p.x + 0.3, p.y - 0.2, p.yaw + 0.1);  // as one clicks
        }
        return text.empty();
      });
  EXPECT_TRUE(played.ok());
  return text;
}

TEST(MapMagnetic, AnInitialPoseIsAsGoodAsTruePoses) {
  TemporaryFolder folder;
  const std::string out = folder.path().string(), log = out + "/survey_00.mcap";
  const Printed made = run_app(
      "simulate --world corridor --size 30,16 --lane-spacing 3 --survey-scan-hz 5 --runs 0 --quiet -o " +
      out);
  ASSERT_EQ(made.exit_status, 0) << made.text;
  const auto report_of = [&](const std::string& poses) {
    const Printed mapped = run_app("map magnetic --map " + out + "/map.yaml " + poses +
                                   " --kernel se --resolution 0.2 --json -o " + out + "/field.nc " + log);
    EXPECT_EQ(mapped.exit_status, 0) << mapped.text;
    return nlohmann::json::parse(mapped.text.substr(mapped.text.find('{')));
  };
  const auto known = report_of("--pose-topic /ground_truth"),
             tracked = report_of("--initial-pose=" + first_pose(log));
  ASSERT_EQ(tracked.at("tracked").size(), 1U);
  EXPECT_LT(tracked.at("tracked")[0].at("typical_sd_m").get<double>(), 0.05);
  EXPECT_GT(tracked.at("tracked")[0].at("mean_score").get<double>(), 0.8);
  EXPECT_FALSE(known.contains("tracked"));
  EXPECT_NEAR(tracked.at("fingerprints").get<double>() / known.at("fingerprints").get<double>(), 1.0, 0.02);
}

TEST(MapMagnetic, AnInitialPoseIsThreeNumbers) {
  const Surveyed& site = Surveyed::get();
  for (const char* text : {"1,2", "1,2,3,4", "a,b,c", "1,2,nan", "1,2,3x"}) {
    const Printed made = run_app("map magnetic --map " + site.path("map.yaml") + " --initial-pose=" + text +
                                 " -o " + site.path("f.nc") + " " + site.path("survey_00.mcap"));
    EXPECT_EQ(made.exit_status, 1) << text;
    EXPECT_TRUE(made.says("give X,Y,YAW")) << made.text;
  }
}

}  // namespace
}  // namespace mstsl::test
