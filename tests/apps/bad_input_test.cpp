#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "run_app.hpp"
#include "site.hpp"

/// What goes wrong in practice, put to the program itself: one sentence and exit status 1, or a count and the
/// run goes on.
namespace mstsl {
namespace {

namespace fs = std::filesystem;
using test::Printed;
using test::run_app;
using test::run_shell;
using test::Site;

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return (std::ostringstream() << stream.rdbuf()).str();
}

void write(const std::string& name, const std::string& content) {
  std::ofstream(Site::get().path(name), std::ios::binary) << content;
}

/// One line that names `file` and says `words`, and status 1.
void expect_refusal(const Printed& printed, const std::string& file, const std::string& words) {
  EXPECT_EQ(printed.exit_status, 1) << printed.text;
  EXPECT_EQ(printed.lines(), 1) << printed.text;
  EXPECT_TRUE(printed.says(file)) << printed.text;
  EXPECT_TRUE(printed.says(words)) << printed.text;
}

/// The site's drive with events changed by `change`, which gives what comes in place of each, localized.
template <typename Change>
Printed localize_changed(const std::string& name, Change change) {
  std::vector<SensorEvent> changed;
  for (const SensorEvent& event : Site::get().events())
    for (const SensorEvent& other : change(event)) changed.push_back(other);
  Site::get().write_log(name + ".mcap", changed);
  return run_app(Site::get().localize(name + ".mcap", name + ".jsonl"));
}

LaserScan with_ranges(LaserScan scan, std::vector<float> ranges_m) {
  scan.ranges_m = std::move(ranges_m);
  return scan;
}

TEST(BadInput, ATruncatedLogIsPlayedToItsEndAndTheCutIsTold) {
  const std::string whole = content_of(Site::get().path("run.mcap"));
  for (const double share : {0.3, 0.6, 0.95}) {
    write("cut.mcap", whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    const Printed printed = run_app(Site::get().localize("cut.mcap", "cut.jsonl"));
    EXPECT_TRUE(printed.exit_status == 0 || printed.exit_status == 3 ||
                (printed.exit_status == 1 && printed.lines() == 1))
        << share << ": " << printed.text;
    EXPECT_TRUE(printed.says("cut.mcap")) << share << ": " << printed.text;
  }
}

TEST(BadInput, ALogCutInItsFirstBytesIsRefused) {
  const std::string whole = content_of(Site::get().path("run.mcap"));
  for (const std::size_t bytes : {0, 1, 8, 30}) {
    write("stub.mcap", whole.substr(0, bytes));
    expect_refusal(run_app(Site::get().localize("stub.mcap", "stub.jsonl")), "stub.mcap", "");
  }
  write("stub.bag", "#ROSBAG V2.0\n");
  expect_refusal(run_app(Site::get().localize("stub.bag", "stub.jsonl")), "stub.bag", "");
}

TEST(BadInput, ScansOfNaNInfinityOrNothingAreCountedOrPassedOver) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  int scans = 0;
  const Printed printed =
      localize_changed("scans", [&](const SensorEvent& event) -> std::vector<SensorEvent> {
        const auto* scan = std::get_if<LaserScan>(&event);
        if (scan == nullptr) return {event};
        std::vector<float> ranges(scan->ranges_m.size(), nan);
        switch (++scans % 8) {
          case 1:
            return {with_ranges(*scan, ranges)};
          case 3:
            return {with_ranges(*scan, std::vector<float>(ranges.size(), infinity))};
          case 5:
            return {with_ranges(*scan, {})};
          case 7:
            return {with_ranges(*scan, std::vector<float>(ranges.size(), -1.0F))};
          default:
            return {event};
        }
      });
  EXPECT_EQ(printed.exit_status, 0) << printed.text;
  EXPECT_TRUE(printed.says("scans without beams dropped: 28") ||
              printed.says("scans without beams dropped: 27"))
      << printed.text;
}

/// Scans without a return; the field as it is, or one that never changes.
Printed localize_blind(const std::string& name, bool with_field) {
  return localize_changed(name, [with_field](const SensorEvent& event) -> std::vector<SensorEvent> {
    if (const auto* scan = std::get_if<LaserScan>(&event))
      return {with_ranges(*scan, std::vector<float>(541, std::numeric_limits<float>::quiet_NaN()))};
    if (const auto* field = std::get_if<FieldReading>(&event); field != nullptr && !with_field)
      return {FieldReading{field->stamp, {18.0, 3.0, -42.0}}};
    return {event};
  });
}

TEST(BadInput, NothingButBlindScansLeavesTheField) {
  const Printed printed = localize_blind("blind", true);
  EXPECT_EQ(printed.exit_status, 0) << printed.text;
  EXPECT_TRUE(printed.says("searches by the field alone")) << printed.text;
}

TEST(BadInput, NothingButBlindScansAndADeadMagnetometerEndsWithoutAFix) {
  const Printed printed = localize_blind("blind_and_dead", false);
  EXPECT_EQ(printed.exit_status, 3) << printed.text;
}

TEST(BadInput, AFieldInTheWrongUnitIsConvertedAndTold) {
  // The log's numbers are taken as microtesla, gauss and so on where they cannot be tesla.
  for (const auto& [name, factor] : {std::pair("microtesla", 1e6), std::pair("gauss", 1e4)}) {
    const Printed printed = localize_changed(name, [&](const SensorEvent& event) -> std::vector<SensorEvent> {
      const auto* field = std::get_if<FieldReading>(&event);
      if (field == nullptr) return {event};
      return {FieldReading{field->stamp, factor * field->sensor_field_uT}};
    });
    EXPECT_EQ(printed.exit_status, 0) << printed.text;
    EXPECT_TRUE(printed.says(name)) << printed.text;
  }
}

TEST(BadInput, AFieldThatIsNoFieldIsRefused) {
  for (const double value : {0.0, 1e30}) {
    const Printed printed =
        localize_changed("dead", [&](const SensorEvent& event) -> std::vector<SensorEvent> {
          const auto* field = std::get_if<FieldReading>(&event);
          if (field == nullptr) return {event};
          return {FieldReading{field->stamp, Eigen::Vector3d::Constant(value)}};
        });
    expect_refusal(printed, "dead.mcap", "magnetic");
  }
}

TEST(BadInput, StampsOutOfOrderAndTwiceAreCounted) {
  const Printed printed =
      localize_changed("stamps", [held = std::vector<SensorEvent>()](const SensorEvent& event) mutable {
        // Every hundred events are written the wrong way round, and each scan twice.
        held.push_back(event);
        if (std::holds_alternative<LaserScan>(event)) held.push_back(event);
        if (held.size() < 20) return std::vector<SensorEvent>();
        std::vector<SensorEvent> out(held.rbegin(), held.rend());
        held.clear();
        return out;
      });
  EXPECT_EQ(printed.exit_status, 0) << printed.text;
  EXPECT_TRUE(printed.says("messages with the stamp of the one before dropped: 220")) << printed.text;
}

TEST(BadInput, OneSensorThatIsNeverHeardIsToldOf) {
  const Printed printed = localize_changed("deaf", [](const SensorEvent& event) {
    return std::holds_alternative<FieldReading>(event) ? std::vector<SensorEvent>()
                                                       : std::vector<SensorEvent>{event};
  });
  expect_refusal(printed, "deaf.mcap", "/imu/mag");
}

TEST(BadInput, AMapWhoseImageIsAbsentOrWithoutAFreeCellIsRefused) {
  const std::string yaml =
      "resolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\nimage: ";
  const auto with_map = [](const std::string& map) {
    return "localize --map " + Site::get().path(map).string() + " --field " +
           Site::get().path("field.nc").string() + " -o " + Site::get().path("map.jsonl").string() + " " +
           Site::get().path("run.mcap").string();
  };
  write("nowhere.yaml", yaml + "nowhere.pgm\n");
  expect_refusal(run_app(with_map("nowhere.yaml")), "nowhere.pgm", "");
  write("black.pgm", "P5 3 2 255\n" + std::string(6, '\0'));
  write("black.yaml", yaml + "black.pgm\n");
  expect_refusal(run_app(with_map("black.yaml")), "black", "free");
  write("binary.yaml", std::string("\x89HDF\r\n\x1a\n\0\0\"\\\x01", 13));
  const Printed binary = run_app(with_map("binary.yaml"));
  expect_refusal(binary, "binary.yaml", "");
  for (const char c : binary.text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << static_cast<int>(c);
}

TEST(BadInput, AFullDiskIsOneSentence) {
  if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Site& site = Site::get();
  const std::string inputs = " --map " + site.path("map.yaml").string() + " --field " +
                             site.path("field.nc").string() + " " + site.path("run.mcap").string();
  expect_refusal(run_app("localize -o /dev/full" + inputs), "/dev/full", "No space left");
  expect_refusal(run_app("localize --tum /dev/full -o " + site.path("full.jsonl").string() + inputs),
                 "/dev/full", "No space left");
}

TEST(BadInput, ALimitOnFileSizesIsOneSentence) {
  const std::string folder = Site::get().path("limited").string();
  const Printed printed = run_shell("ulimit -f 60; " + std::string(MSTSL_APP) +
                                    " simulate --world office-wing --runs 1 -o " + folder);
  expect_refusal(printed, folder, "File too large");
}

// --foreground: else timeout sends the signal to the process and to its group, two in all, and the second
// ends it.
TEST(BadInput, AnInterruptEndsInOrder) {
  const std::string folder = Site::get().path("interrupted").string();
  const Printed printed =
      run_shell("timeout --foreground --preserve-status -s INT 2 " + std::string(MSTSL_APP) +
                " simulate --world office-wing --runs 500 -o " + folder);
  expect_refusal(printed, folder, "stopped");
}

TEST(BadInput, APipeThatNobodyWritesToIsRefusedOrInterrupted) {
  const std::string pipe = Site::get().path("pipe").string();
  ASSERT_EQ(run_shell("mkfifo " + pipe).exit_status, 0);
  expect_refusal(run_app(Site::get().localize("pipe", "pipe.jsonl")), pipe, "not a regular file");
  expect_refusal(run_shell("timeout --foreground --preserve-status -s INT 2 " + std::string(MSTSL_APP) +
                           " localize --map " + pipe + " --field x.nc -o /dev/null x.mcap"),
                 pipe, "Interrupted");
}

TEST(BadInput, AnOutputThatIsAnInputIsRefusedAndTheInputKept) {
  const std::string before = content_of(Site::get().path("run.mcap"));
  expect_refusal(run_app(Site::get().localize("run.mcap", "run.mcap")), "run.mcap", "overwritten");
  EXPECT_EQ(content_of(Site::get().path("run.mcap")), before);
}

TEST(BadInput, WrongWordsAndNumbersAreWrongUsage) {
  const auto expect_wrong = [](const std::string& arguments, const std::string& words) {
    const Printed printed = run_app(arguments);
    EXPECT_EQ(printed.exit_status, 2) << arguments << ": " << printed.text;
    EXPECT_TRUE(printed.says(words)) << arguments << ": " << printed.text;
  };
  const std::string run = Site::get().localize("run.mcap", "usage.jsonl"),
                    simulate = "simulate --world carpark -o " + Site::get().path("usage").string();
  expect_wrong("", "subcommand");
  expect_wrong("locate", "'locate' is no command");
  expect_wrong(run + " --threads -1", "--threads");
  expect_wrong(run + " --seed -1", "'-1'");
  expect_wrong(run + " --seed 99999999999999999999", "99999999999999999999");
  expect_wrong(simulate + " --speed nan", "--speed");
  expect_wrong(simulate + " --size nan,20", "--size");
  expect_wrong(simulate + " --people inf", "--people");
}

TEST(BadInput, FoldersAndPathsWithoutAFolderAreRefused) {
  const Site& site = Site::get();
  const std::string folder = site.path("").string();
  const std::string start = "localize --field " + site.path("field.nc").string() + " --map ";
  expect_refusal(run_app(start + folder + " -o /dev/null " + site.path("run.mcap").string()), "folder", "");
  expect_refusal(run_app(Site::get().localize("run.mcap", "no/such/folder/x.jsonl")), "x.jsonl", "folder");
  EXPECT_EQ(run_app(Site::get().localize("run.mcap", "'\xc3\xbcn\xc3\xaf \xe4\xb8\xad.jsonl'")).exit_status,
            0);
}

}  // namespace
}  // namespace mstsl
