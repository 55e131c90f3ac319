#include <filesystem>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mstsl/io/field_map_file.hpp"

#include "run_app.hpp"
#include "test_support.hpp"

namespace mstsl::test {
namespace {

/// A simulated building whose field map is made and in which some things are then moved, for all tests.
class Changed {
 public:
  static const Changed& get() {
    static const Changed changed;
    return changed;
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string update(const std::string& more) const {
    return "map update --map " + path("map.yaml") + " --field " + path("field.nc") + " " + more;
  }

 private:
  Changed() {
    const std::string folder = folder_.path().string();
    for (const std::string& command : {"simulate --world corridor --size 30,16 --lane-spacing 1 "
                                       "--survey-scan-hz 0 --runs 1 --run-length 8 "
                                       "--scan-hz 10 --moved 0.5 --quiet -o " +
                                           folder,
                                       "map magnetic --map " + path("map.yaml") +
                                           " --pose-topic /ground_truth --resolution 0.1 --quiet -o " +
                                           path("field.nc") + " " + path("survey_00.mcap")}) {
      const Printed made = run_app(command);
      if (made.exit_status != 0) throw std::runtime_error(made.text);
    }
  }
  TemporaryFolder folder_;
};

nlohmann::json report_of(const Printed& printed) {
  return nlohmann::json::parse(printed.text.substr(printed.text.find('{')));
}

TEST(MapUpdate, FindsTheDriveByItselfAndMakesAMapThatKnowsBoth) {
  const Changed& site = Changed::get();
  const Printed made =
      run_app(site.update("--json --quiet -o " + site.path("new.nc") + " " + site.path("run_00.mcap")));
  ASSERT_EQ(made.exit_status, 0) << made.text;
  const auto report = report_of(made);
  EXPECT_LT(report.at("drives").at(0).at("found_after_m").get<double>(), 5.0);
  EXPECT_LT(report.at("drives").at(0).at("unexplained_share").get<double>(), 0.3);
  const FieldMap before = must(io::read_field_map(site.path("field.nc")));
  const FieldMap after = must(io::read_field_map(site.path("new.nc")));
  ASSERT_EQ(before.drives.size(), 1U);
  ASSERT_EQ(after.drives.size(), 2U);
  EXPECT_EQ(after.drives[1].name, "run_00.mcap");
  EXPECT_EQ(after.replaced.size(), report.at("fingerprints_replaced").get<std::size_t>());
  const std::size_t held = after.fingerprints.size() + after.replaced.size();
  const std::size_t known = before.fingerprints.size() + report.at("fingerprints_added").get<std::size_t>();
  EXPECT_LE(held, known);
  EXPECT_GE(held + 20, known) << "a few are outliers";
  EXPECT_EQ(after.hyperparameters.at("length_scale_x_m"), before.hyperparameters.at("length_scale_x_m"));
  EXPECT_EQ(after.geometry.resolution_m, before.geometry.resolution_m);

  // Held against a map that holds it, a drive shows no more.
  const auto error_of = [&](const char* field) {
    const Printed said = run_app("map update --json --quiet --map " + site.path("map.yaml") + " --field " +
                                 site.path(field) + " " + site.path("run_00.mcap"));
    EXPECT_EQ(said.exit_status, 0) << said.text;
    double sum = 0.0;
    for (const double rms : report_of(said).at("drives").at(0).at("rms_uT")) sum += rms * rms;
    return sum;
  };
  EXPECT_LE(error_of("new.nc"), error_of("field.nc"));
}

TEST(MapUpdate, WritesNothingButWhatIsAskedFor) {
  const Changed& site = Changed::get();
  const auto before = std::filesystem::last_write_time(site.path("field.nc"));
  const Printed said = run_app(site.update(site.path("run_00.mcap")));
  EXPECT_EQ(said.exit_status, 0) << said.text;
  EXPECT_TRUE(said.says("nothing was written; give -o")) << said.text;
  EXPECT_EQ(std::filesystem::last_write_time(site.path("field.nc")), before);
  EXPECT_EQ(
      run_app(site.update("--picture " + site.path("p.svg") + " " + site.path("run_00.mcap"))).exit_status,
      0);
  EXPECT_TRUE(std::filesystem::exists(site.path("p.svg")));

  // It may take the old map's name, but no log's.
  std::filesystem::copy_file(site.path("field.nc"), site.path("own.nc"));
  const std::string log = site.path("run_00.mcap"), own = site.path("own.nc");
  const std::string update = "map update --quiet --map " + site.path("map.yaml") + " --field " + own;
  EXPECT_EQ(run_app(update + " -o " + log + " " + log).exit_status, 1);
  EXPECT_EQ(run_app(update + " -o " + own + " " + log).exit_status, 0);
  EXPECT_EQ(must(io::read_field_map(own)).drives.size(), 2U);

  // A wrong start is said.
  const Printed wrong = run_app(site.update("--initial-pose 500,500,0 " + site.path("run_00.mcap")));
  EXPECT_EQ(wrong.exit_status, 1);
  EXPECT_EQ(wrong.lines(), 1) << wrong.text;
}

}  // namespace
}  // namespace mstsl::test
