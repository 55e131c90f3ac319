#include "mstsl/eval/hard_protocol.hpp"

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "mstsl/eval/hard_report.hpp"
#include "mstsl/eval/hard_trace.hpp"

#include "eval/hard_building.hpp"
#include "eval/hard_crowd.hpp"
#include "eval/hard_listener.hpp"
#include "test_support.hpp"
#include "thread_crew.hpp"

namespace mstsl {
namespace {

namespace fs = std::filesystem;
using test::must;

/// Says, scan by scan, how far from the truth it is (m); nothing where it has no pose.
struct Scripted {
  std::vector<std::optional<double>> errors_m;
  double truth_x_per_scan_m = 0.5;
  int scans = 0;
  Estimate now;
  void observe(const OdometryReading&) {}
  void observe(const OdometryRestart&) {}
  void observe(const FieldReading&) {}
  void observe(const LaserScan& scan) {
    const auto& error = errors_m[static_cast<std::size_t>(scans)];
    now.stamp = scan.stamp;
    now.travelled_m = truth_x_per_scan_m * scans;
    now.probability = 0.9995;
    now.map_T_base = error ? std::optional(Pose2{truth_x_per_scan_m * scans + *error, 0, 0}) : std::nullopt;
    now.status = error ? LocalizationStatus::kLocalized : LocalizationStatus::kLost;
    ++scans;
  }
  Estimate estimate() const { return now; }
  LocalizerReport report() const { return {}; }
};

/// One scan a second, half a metre driven between two.
HardRecord listen(const std::vector<std::optional<double>>& errors_m, std::optional<int> set_down = {}) {
  HardListener listener{AnyLocalizer(Scripted{errors_m})};
  Trajectory truth;
  for (std::size_t i = 0; i < errors_m.size(); ++i) {
    const Stamp stamp = Stamp::from_seconds(static_cast<double>(i));
    truth.add(stamp, {0.5 * static_cast<double>(i), 0, 0});
    LaserScan scan;
    scan.stamp = stamp;
    listener.observe(scan);
  }
  return listener.record(truth, set_down ? std::optional(Stamp::from_seconds(*set_down)) : std::nullopt);
}

TEST(HardListener, CountsClaimsAndDistances) {
  const HardRecord record = listen({{}, {}, 0.1, 0.3, 0.7, 0.1});
  EXPECT_EQ(record.estimates, 6u);
  EXPECT_EQ(record.answers, 4u);
  EXPECT_EQ(record.claims_at_999, 4u);
  EXPECT_EQ(record.wrong_at_999, 1u);
  EXPECT_DOUBLE_EQ(*record.correct_distance_m, 1.0);
  EXPECT_DOUBLE_EQ(*record.first_s, 2.0);
  EXPECT_DOUBLE_EQ(record.driven_m, 2.5);
  EXPECT_DOUBLE_EQ(record.right_m, 1.0) << "from the 3rd scan to the 5th";
  EXPECT_TRUE(record.succeeded());
  EXPECT_TRUE(record.first->tight);
  EXPECT_EQ(record.sample.size(), 4u);
  EXPECT_EQ(record.false_alarms, 0u);
}

TEST(HardListener, ARightPoseWithdrawnIsAFalseAlarm) {
  EXPECT_EQ(listen({0.1, {}, 0.1, {}}).false_alarms, 2u);
  EXPECT_EQ(listen({0.1, 0.1, {}, {}}, 2).false_alarms, 0u) << "it was carried";
  EXPECT_EQ(listen({0.9, {}, {}}).false_alarms, 0u) << "it was wrong";
}

TEST(HardListener, TellsWhenACarryWasNoticedAndMended) {
  const auto outcome = *listen({0.1, 0.1, 5.0, 5.0, {}, {}, 0.2}, 2).kidnap;
  EXPECT_TRUE(outcome.localized_before);
  EXPECT_DOUBLE_EQ(*outcome.noticed_m, 1.0);
  EXPECT_DOUBLE_EQ(*outcome.recovered_m, 2.0);
  EXPECT_FALSE(outcome.wrong_again);
  EXPECT_TRUE(listen({0.1, 0.1, {}, 3.0}, 2).kidnap->wrong_again);
  EXPECT_FALSE(listen({0.1, 0.1, 5.0, 5.0}, 2).kidnap->noticed_m);
  EXPECT_FALSE(listen({{}, {}, 0.1}, 2).kidnap->localized_before);
}

TEST(HardRecord, ComesBackFromItsLine) {
  HardRecord record = listen({{}, 0.1, 0.2, {}, 0.9}, 3);
  record.key = {"kidnap", "office", "all", "joint", 7};
  record.options = "seed 1", record.simulation_ms = 12.5;
  const std::string line = to_line(record);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const HardRecord back = must(record_from_line(line));
  EXPECT_EQ(to_line(back), line);
  EXPECT_EQ(back.key, record.key);
  for (std::size_t cut = 0; cut < line.size(); cut += 7) EXPECT_FALSE(record_from_line(line.substr(0, cut)));
}

TEST(CostHistogram, GivesQuantilesWithinItsBins) {
  CostHistogram cost;
  for (int i = 1; i <= 1000; ++i) cost.add(0.1 * i);
  EXPECT_EQ(cost.count(), 1000u);
  EXPECT_NEAR(cost.quantile_ms(0.5), 50.0, 6.0);
  EXPECT_NEAR(cost.quantile_ms(0.95), 95.0, 6.0);
  EXPECT_DOUBLE_EQ(cost.max_ms(), 100.0);
  EXPECT_DOUBLE_EQ(CostHistogram{}.quantile_ms(0.5), 0.0);
}

TEST(Crowd, HidesWhatItIsAskedToInTheOpenAndNothingBehindAWall) {
  LaserScan open;
  open.angle_min_rad = -2.35;
  open.angle_increment_rad = 4.7 / 540;
  open.ranges_m.assign(541, 20.0f);
  Crowd crowd(0.3, open, Random(1));
  double hidden = 0.0;
  for (int second = 0; second < 60; ++second) {
    LaserScan scan = open;
    crowd.hide(scan, second);
    for (const float range : scan.ranges_m) hidden += range < 19.0f ? 1.0 / (541 * 60) : 0.0;
  }
  EXPECT_GT(hidden, 0.15);
  EXPECT_LT(hidden, 0.33);
  LaserScan near = open;
  near.ranges_m.assign(541, 0.3f);
  crowd.hide(near, 0.0);
  for (const float range : near.ranges_m) EXPECT_EQ(range, 0.3f);
}

TEST(HardRows, SumUpByHand) {
  std::vector<HardRecord> records;
  for (const double error : {0.1, 0.3, 2.0}) {
    records.push_back(listen({{}, {}, error, error}));
    records.back().key = {"fix", "office", "none", "joint", static_cast<int>(records.size())};
  }
  records.push_back(listen({{}, {}}));
  records.back().key = {"fix", "aisles", "none", "joint", 0};
  const HardRow all = hard_rows(records).front();
  EXPECT_EQ(all.runs, 4u);
  EXPECT_EQ(all.success.hits, 2u);
  EXPECT_EQ(all.tight.hits, 1u);
  EXPECT_EQ(all.answered.hits, 3u);
  EXPECT_EQ(all.first_wrong_at_999.hits, 1u);
  EXPECT_EQ(all.first_wrong_at_999.of, 3u);
  EXPECT_EQ(all.runs_wrong_at_999.of, 4u);
  EXPECT_DOUBLE_EQ(quantile(all.correct_distance_m, 0.5), 1.0);
  EXPECT_NEAR(quantile(all.error_m, 0.5), 0.2, 1e-9);
  // By hand: two of three claims of 0.9995 right.
  EXPECT_NEAR(all.first_answers.brier, (2 * 0.0005 * 0.0005 + 0.9995 * 0.9995) / 3, 1e-12);
}

TEST(WeakField, HasTheSpreadAskedFor) {
  const sim::World world = must(sim::make_world("office", {}, Random(3)));
  const double share = 3.0 / field_spread_uT(world);
  ASSERT_LT(share, 1.0);
  const auto field = weakened(world, share);
  const Eigen::Vector3d at(1, 0, 0.7), earth = world.field().earth().in_map_uT();
  EXPECT_NEAR((field({}, at) - earth).norm(), share * (world.field_uT(at) - earth).norm(), 1e-9);
}

std::string without_cost(HardRecord record) {
  record.searching = {}, record.tracking = {}, record.simulation_ms = 0.0;
  return to_line(record);
}

/// Runs that are driven again to be looked at are the very ones that were recorded.
void expect_same_runs(const HardProtocolOptions& options, const std::vector<HardRecord>& records) {
  const auto starts = worth_looking_at(records, options.methods, 1);
  const auto traces = must(trace_hard_runs(options, starts));
  ASSERT_EQ(traces.size(), 1u);
  const auto record = std::ranges::find_if(records, [&](const HardRecord& r) {
    return r.key.disturbance == starts[0].disturbance && r.key.run == starts[0].run;
  });
  const RunTrace& trace = traces.front();
  ASSERT_EQ(trace.methods.size(), options.methods.size());
  EXPECT_EQ(trace.methods[0].name, options.methods[0]);
  const RunEvaluation run = evaluate_run(trace.methods[0].estimates, trace.truth);
  EXPECT_EQ(run.estimates, record->estimates);
  EXPECT_EQ(run.answers.size(), record->answers);
  EXPECT_EQ(run.correct_distance_m, record->correct_distance_m);
  EXPECT_GT(trace.scans.size(), 5u);
}

TEST(HardProtocol, KeepsRunsAndIsTheSameAtAnyNumberOfThreads) {
  const fs::path folder = fs::temp_directory_path() / "mstsl_hard_protocol_test";
  fs::remove_all(folder);
  HardProtocolOptions options;
  options.worlds = {"office"};
  options.disturbances = {"sparse-survey"};  // the quickest to survey
  options.runs = 4;
  options.length_m = 4.0;
  options.beams = 181;
  options.folder = folder;
  options.build = "test";
  options.threads = {2};
  const auto first = must(run_hard_protocol(options));
  ASSERT_EQ(first.size(), 4u);
  const auto lines = [&] {
    std::ifstream file(folder / "runs.jsonl");
    int count = 0;
    for (std::string line; std::getline(file, line);) ++count;
    return count;
  };
  EXPECT_EQ(lines(), 4);
  EXPECT_EQ(must(run_hard_protocol(options)).size(), 4u);
  EXPECT_EQ(lines(), 4) << "what is finished is not run again";
  expect_same_runs(options, first);

  { std::ofstream(folder / "runs.jsonl", std::ios::app) << "{\"set\": \"cut o"; }
  options.build = "another", options.threads = {1};
  std::vector<std::vector<HardRecord>> again(2);
  test::as_crew(2, [&](const Crew& crew) {  // one in this folder, one in its own
    HardProtocolOptions mine = options;
    mine.crew = crew;
    if (!crew.leads()) mine.folder /= "elsewhere";
    again[static_cast<std::size_t>(crew.rank)] = must(run_hard_protocol(mine));
  });
  EXPECT_EQ(lines(), 9) << "another build's runs are not taken for this one's";
  for (const auto& records : again) {
    ASSERT_EQ(records.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(without_cost(records[i]), without_cost(first[i]));
    EXPECT_EQ(hard_json(records, {}), hard_json(first, {}));
  }
  fs::remove_all(folder);
}

/// The small benchmark of every build: who is best where corridors look alike, on the same events.
TEST(HardProtocol, TheMethodsOrderHolds) {
  const test::TemporaryFolder folder;
  HardProtocolOptions options;
  options.methods = {"joint", "two-step", "global-scan", "mag-pf"};
  options.worlds = {"symmetric-loop"};
  options.disturbances = {"none"};
  options.runs = 6;
  options.length_m = 8.0;
  options.beams = 271;
  options.seed = 50;
  options.folder = folder.path();
  std::map<std::string, int> right, wrong;
  for (const HardRecord& r : must(run_hard_protocol(options))) {
    right[r.key.method] += r.first && r.first->right ? 1 : 0;
    wrong[r.key.method] += r.wrong_at_99 > 0 ? 1 : 0;
  }
  EXPECT_EQ(right["joint"], options.runs);
  EXPECT_EQ(wrong["joint"], 0);
  for (const std::string& method : options.methods) EXPECT_LE(right[method], right["joint"]) << method;
  EXPECT_LT(right["global-scan"], options.runs) << "two ways round look alike to a lidar";
}

HardRecord short_record(const std::string& world, const std::string& disturbance, int run, bool right) {
  HardRecord record;
  record.key = {"fix", world, disturbance, "joint", run};
  record.first = JudgedAnswer{};
  record.first->right = right;
  if (right) record.correct_distance_m = 1.0;
  return record;
}

TEST(HardCsv, HasAColumnForEachNameAndSaysWhatTheRowsSay) {
  std::vector<HardRecord> records;
  for (int run = 0; run < 10; ++run) records.push_back(short_record("loop", "none", run, run < 7));
  records.front().sample = {*records.front().first};
  records.front().sample.front().nees = 2.5;
  EXPECT_EQ(must(record_from_line(to_line(records.front()))).sample.front().nees, 2.5);
  std::vector<std::vector<std::string>> table;
  std::istringstream lines(hard_csv(records));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line + ",end");
    table.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) table.back().push_back(cell);
  }
  ASSERT_EQ(table.size(), 1 + hard_rows(records).size());
  const auto of = [&](const std::string& name) -> std::string {
    const auto column = std::find(table[0].begin(), table[0].end(), name);
    return column == table[0].end() ? "absent"
                                    : table[1][static_cast<std::size_t>(column - table[0].begin())];
  };
  for (const auto& row : table) EXPECT_EQ(row.size(), table[0].size());
  EXPECT_EQ(of("success"), "7");
  EXPECT_EQ(of("success_of"), "10");
  EXPECT_EQ(of("correct_distance_m_median"), "1");
  EXPECT_EQ(of("time_to_fix_s_median"), "") << "no such number";
  EXPECT_EQ(of("nees_mean"), "2.5");
}

TEST(HardTrace, LooksAtEachWorldAndAtWhatWentWrong) {
  std::vector<HardRecord> records;
  for (const char* world : {"loop", "office"})
    for (const char* disturbance : {"none", "all"})
      for (int run = 0; run < 3; ++run) records.push_back(short_record(world, disturbance, run, run != 2));
  records.front().false_alarms = 1;
  const std::vector<HardStart> starts = worth_looking_at(records, {"joint"}, 5);
  const std::vector<HardStart> expected{
      {"loop", "all", 0}, {"office", "all", 0}, {"loop", "none", 0}, {"loop", "none", 2}, {"loop", "all", 2}};
  EXPECT_EQ(starts, expected);
  EXPECT_EQ(worth_looking_at(records, {"joint"}, 1).size(), 1u);
  EXPECT_TRUE(worth_looking_at({}, {"joint"}, 5).empty());
}

TEST(ScanRecorder, KeepsFewScansHoweverLongTheRun) {
  ScanRecorder recorder(Rig{}, 50);
  LaserScan scan;
  scan.angle_increment_rad = 0.01;
  scan.range_max_m = 10.0;
  scan.ranges_m.assign(600, 3.0F);
  for (int i = 0; i < 5000; ++i) {
    scan.stamp = Stamp::from_seconds(0.1 * i);
    recorder.observe(scan);
  }
  const std::vector<TracedScan> scans = recorder.take();
  EXPECT_GE(scans.size(), 50u);
  EXPECT_LT(scans.size(), 100u);
  EXPECT_EQ(scans.front().stamp, Stamp::from_seconds(0.0));
  EXPECT_GT(scans.back().stamp, Stamp::from_seconds(480.0));
  for (std::size_t i = 1; i < scans.size(); ++i) EXPECT_GT(scans[i].stamp, scans[i - 1].stamp);
  for (const TracedScan& kept : scans) EXPECT_LE(kept.points_base_m.size(), 90u);
}

TEST(HardProtocol, RefusesWhatIsNotThere) {
  EXPECT_FALSE(trace_hard_runs({}, {{"atlantis", "none", 0}}));
  EXPECT_FALSE(trace_hard_runs({}, {{"office", "rain", 0}}));
  HardProtocolOptions options;
  options.worlds = {"atlantis"};
  EXPECT_NE(run_hard_protocol(options).error().message().find("symmetric-loop"), std::string::npos);
  options = {};
  options.methods = {"guess"};
  EXPECT_FALSE(run_hard_protocol(options));
  options = {};
  options.disturbances = {"rain"};
  EXPECT_FALSE(run_hard_protocol(options));
  options = {};
  options.runs = 0;
  EXPECT_FALSE(run_hard_protocol(options));
}

}  // namespace
}  // namespace mstsl
