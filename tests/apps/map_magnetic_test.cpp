#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

}  // namespace
}  // namespace mstsl::test
