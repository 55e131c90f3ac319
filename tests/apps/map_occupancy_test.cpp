#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/file_bytes.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/tum.hpp"

#include "run_app.hpp"
#include "test_support.hpp"

namespace mstsl::test {
namespace {

/// Recorded drives through a small simulated building, and no map of it.
class Driven {
 public:
  static const Driven& get() {
    static const Driven driven;
    return driven;
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string log() const { return path("survey_00.mcap"); }

 private:
  Driven() {
    const Printed made = run_app(
        "simulate --world corridor --size 30,16 --lane-spacing 3 --survey-scan-hz 5 --runs 2 --quiet -o " +
        folder_.path().string());
    if (made.exit_status != 0) throw std::runtime_error(made.text);
  }
  TemporaryFolder folder_;
};

nlohmann::json json_in(const std::string& text) { return nlohmann::json::parse(text.substr(text.find('{'))); }

TEST(MapOccupancy, MakesAMapAndSaysHowGoodItIs) {
  const Driven& site = Driven::get();
  const Printed made = run_app("map occupancy --json --truth-topic /ground_truth -o " +
                               site.path("made.yaml") + " --tum " + site.path("way.tum") + " --picture " +
                               site.path("made.png") + " --report " + site.path("r.json") + " " + site.log());
  ASSERT_EQ(made.exit_status, 0) << made.text;
  const auto report = json_in(made.text);
  EXPECT_LT(report.at("against_truth").at("ate_rms_m").get<double>(), 0.15);
  EXPECT_GT(report.at("loops").at("closed").get<int>(), 10);
  EXPECT_EQ(report.at("drives").size(), 1U);
  const OccupancyGrid drawn = must(io::read_map(site.path("made.yaml")));
  const OccupancyGrid real = must(io::read_map(site.path("map.yaml")));
  const auto free_m2 = [](const OccupancyGrid& g) {
    return static_cast<double>(count(g, CellState::kFree)) * g.geometry().resolution_m *
           g.geometry().resolution_m;
  };
  EXPECT_NEAR(free_m2(drawn) / free_m2(real), 1.0, 0.15);
  EXPECT_GT(must(io::read_tum(site.path("way.tum"))).size(), 1000U);
  EXPECT_GT(std::filesystem::file_size(site.path("made.png")), 10'000U);
  EXPECT_EQ(json_in(must(io::read_file(site.path("r.json"), 1U << 26))), report);
}

TEST(MapOccupancy, IsTheSameAtAnyNumberOfThreads) {
  const Driven& site = Driven::get();
  for (const char* threads : {"1", "4"})
    ASSERT_EQ(run_app(std::string("map occupancy --quiet --threads ") + threads + " -o " +
                      site.path(std::string("t") + threads + ".yaml") + " --tum " +
                      site.path(std::string("t") + threads + ".tum") + " " + site.log())
                  .exit_status,
              0);
  EXPECT_EQ(must(io::read_file(site.path("t1.tum"), 1U << 26)),
            must(io::read_file(site.path("t4.tum"), 1U << 26)));
}

TEST(MapOccupancy, GoesWithoutOdometryAndSaysSo) {
  const Driven& site = Driven::get();
  const Printed made = run_app("map occupancy --odometry-topic /wheels -o " + site.path("scans.yaml") + " " +
                               site.path("run_00.mcap"));
  ASSERT_EQ(made.exit_status, 0) << made.text;
  EXPECT_TRUE(made.says("no odometry under /wheels")) << made.text;
  EXPECT_GT(count(must(io::read_map(site.path("scans.yaml"))), CellState::kFree), 10'000U);
}

TEST(MapOccupancy, AsksForNoLoopOnAShortDrive) {
  const Driven& site = Driven::get();
  const Printed made =
      run_app("map occupancy -o " + site.path("short.yaml") + " " + site.path("run_00.mcap"));
  ASSERT_EQ(made.exit_status, 0) << made.text;
  EXPECT_FALSE(made.says("no loop was closed")) << "14 m need none: " << made.text;
}

TEST(MapOccupancy, AsksForWhatItNeeds) {
  const Driven& site = Driven::get();
  EXPECT_EQ(run_app("map occupancy -o x.yaml").exit_status, 2);
  EXPECT_EQ(run_app("map occupancy -o " + site.path("x.yaml") + " " + site.path("absent.mcap")).exit_status,
            1);
  const Printed no_scans =
      run_app("map occupancy --scan-topic /nothing -o " + site.path("x.yaml") + " " + site.log());
  EXPECT_EQ(no_scans.exit_status, 1);
  EXPECT_TRUE(no_scans.says("/nothing")) << no_scans.text;
  const Printed own_log =
      run_app("map occupancy -o " + site.path("x.yaml") + " --report " + site.log() + " " + site.log());
  EXPECT_EQ(own_log.exit_status, 1) << "a report must not overwrite the log";
  EXPECT_FALSE(std::filesystem::exists(site.path("x.yaml")));
}

TEST(MapAll, MakesBothMapsOfSeveralDrives) {
  const Driven& site = Driven::get();
  const Printed made = run_app("map all --json --truth-topic /ground_truth -o " + site.path("all") + " " +
                               site.log() + " " + site.path("run_00.mcap"));
  // The run has no true poses under that topic; without the wish for them both are joined.
  EXPECT_EQ(made.exit_status, 1) << made.text;
  const Printed joined =
      run_app("map all --json -o " + site.path("all") + " " + site.log() + " " + site.path("run_00.mcap"));
  ASSERT_EQ(joined.exit_status, 0) << joined.text;
  EXPECT_EQ(json_in(joined.text).at("drives").size(), 2U);
  const FieldMap field = must(io::read_field_map(site.path("all/field.nc")));
  EXPECT_GT(field.geometry.size(), 1000U);
  EXPECT_TRUE(std::filesystem::exists(site.path("all/trajectory_1.tum")));
  const Printed located =
      run_app("localize --quiet --map " + site.path("all/map.yaml") + " --field " +
              site.path("all/field.nc") + " -o " + site.path("e.jsonl") + " " + site.path("run_01.mcap"));
  EXPECT_EQ(located.exit_status, 0) << located.text;
}

}  // namespace
}  // namespace mstsl::test
