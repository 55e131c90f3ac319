#include "mstsl/report/page.hpp"

#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "report/run_json.hpp"
#include "test_support.hpp"

namespace mstsl {
namespace {

/// A room of 12 by 6 m with a field that grows along it.
std::shared_ptr<const TracedPlace> room() {
  const GridGeometry g{.resolution_m = 0.1, .columns = 140, .rows = 80, .map_T_grid = {-1, -1, 0}};
  OccupancyGrid grid(g, CellState::kUnknown);
  for (int row = 10; row < 70; ++row)
    for (int column = 10; column < 130; ++column) {
      const bool wall = row == 10 || row == 69 || column == 10 || column == 129;
      grid[{column, row}] = wall ? CellState::kOccupied : CellState::kFree;
    }
  FieldMap field;
  field.geometry = g;
  field.variance_uT2.assign(g.size(), Eigen::Vector3f::Ones());
  field.supported.assign(g.size(), 1);
  for (std::size_t i = 0; i < g.size(); ++i)
    field.mean_uT.emplace_back(20.0F + 0.2F * static_cast<float>(g.cell(i).column), 0.0F, 40.0F);
  return std::make_shared<const TracedPlace>(TracedPlace{"room", std::move(grid), std::move(field)});
}

/// Driven along the room in ten seconds; one method is right, the other stands on its head.
RunTrace run_in(const std::shared_ptr<const TracedPlace>& place, const std::string& name) {
  RunTrace run{name, place, {}, {}, {{"joint", {}}, {"global-scan", {}}}};
  for (int i = 0; i <= 100; ++i) {
    const Stamp stamp = Stamp::from_seconds(1000.0 + 0.1 * i);
    const Pose2 truth{1.0 + 0.1 * i, 3.0, 0.0}, turned{11.0 - 0.1 * i, 3.0, kPi};
    run.truth.add(stamp, truth);
    run.scans.push_back({stamp, {{0.0, 2.9}, {0.0, -2.9}, {11.9 - truth.x, 0.0}}});
    Estimate estimate;
    estimate.stamp = stamp;
    estimate.travelled_m = 0.1 * i;
    estimate.probability = i < 20 ? 0.5 : 0.9995;
    estimate.hypotheses = {{truth, 0.6}, {turned, 0.4}};
    if (i >= 20) estimate.map_T_base = truth;
    run.methods[0].estimates.push_back(estimate);
    estimate.hypotheses = {{turned, 1.0}};
    if (i >= 20) estimate.map_T_base = turned;
    run.methods[1].estimates.push_back(estimate);
  }
  return run;
}

HardRecord record(const std::string& method, int run, std::optional<double> way_m) {
  HardRecord record;
  record.key = {"fix", run % 2 == 0 ? "loop" : "office", "all", method, run};
  record.options = "seed 1";
  record.driven_m = 14.0;
  record.correct_distance_m = way_m;
  record.first = JudgedAnswer{};
  record.first->right = way_m.has_value();
  record.first->probability = way_m ? 0.9995 : 0.7;
  record.sample.assign(5, *record.first);
  record.tracking.add(0.2);
  return record;
}

report::Page page() {
  std::vector<HardRecord> records;
  for (int run = 0; run < 10; ++run) {
    records.push_back(record("joint", run, 1.0 + 0.3 * run));
    records.push_back(record("global-scan", run, run < 4 ? std::optional(0.5) : std::nullopt));
  }
  const auto place = room();
  return {"A <page>",
          "made for a test",
          report::hard_summary(records, {"abc", "def", 1, 10.0}),
          {run_in(place, "first run"), run_in(place, "</script> second & last")}};
}

/// The paper's protocol: two models, four waypoints driven five times each.
report::Page paper_page() {
  ProtocolResult result;
  result.world = "corridor";
  result.hypotheses = 5;
  result.fingerprints = 1234;
  result.models = {FieldModel::kGpr, FieldModel::kBilinear};
  for (int waypoint = 0; waypoint < 4; ++waypoint)
    for (int run = 0; run < 5; ++run)
      for (const FieldModel model : result.models) {
        const double way_m = 1.0 + 0.1 * run + 0.5 * waypoint + (model == FieldModel::kGpr ? 0.0 : 1.0);
        const JudgedAnswer answer{way_m, 0.99, {0.02 + 0.01 * run, 0.01}, true, true};
        ProtocolRun& made = result.runs.emplace_back(ProtocolRun{waypoint, run, model, 0.02, {}});
        made.evaluation.initialisation = JudgedInitialisation{5, 0.4, 0.4, true};
        if (model == FieldModel::kBilinear && run == 0) continue;  // no answer
        made.evaluation.answers = {answer};
        made.evaluation.last = answer;
        made.evaluation.correct_distance_m = way_m;
      }
  report::Page page{"The paper", "made for a test", "", {run_in(room(), "waypoint 1")}};
  page.paper_json = report::paper_summary(result);
  return page;
}

TEST(OurPage, IsWritten) {
  std::ofstream(MSTSL_PAPER_PAGE) << report::html(paper_page());
  std::ofstream(MSTSL_PAGE) << report::html(page());
  EXPECT_TRUE(std::filesystem::exists(MSTSL_PAGE));
}

TEST(Page, IsTheSameBytesForTheSameContent) { EXPECT_EQ(report::html(page()), report::html(page())); }

TEST(Page, HasNoHoleAndNothingThatEndsItsElements) {
  const std::string html = report::html(page());
  EXPECT_NE(html.find("<title>A &lt;page&gt;</title>"), std::string::npos);
  const std::string scripts = html.substr(html.find("<script"));
  EXPECT_EQ(html.find("{{title"), std::string::npos);
  EXPECT_EQ(html.find("</script> second"), std::string::npos);
  const auto count = [&](std::string_view word) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = html.find(word, at)) != std::string::npos; at += word.size()) ++found;
    return found;
  };
  EXPECT_EQ(count("<script"), count("</script>"));
  EXPECT_EQ(count("id=\"place-"), 1u) << "two runs share their place";
  EXPECT_EQ(count("id=\"run-"), 3u) << "two runs and their names";
}

TEST(Page, StandsWithoutAnythingToShow) {
  const std::string html = report::html({"empty", "", "", {}});
  EXPECT_NE(html.find("id=\"summary-data\">null<"), std::string::npos);
}

TEST(RunJson, ThinsLongRuns) {
  RunTrace run = run_in(room(), "long");
  for (int i = 0; i < 20'000; ++i) {
    Estimate more = run.methods[0].estimates.back();
    more.stamp = more.stamp + 0.1;
    run.methods[0].estimates.push_back(more);
  }
  const auto json = nlohmann::json::parse(report::run_json(run, 0));
  EXPECT_LE(json.at("methods")[0].at("t").size(), 1500u);
  EXPECT_GT(json.at("methods")[0].at("t").size(), 700u);
  EXPECT_EQ(json.at("methods")[1].at("t").size(), 101u);
  EXPECT_DOUBLE_EQ(json.at("methods")[1].at("t").back(), 10.0);
}

TEST(HardSummary, HoldsTheWaysInOrder) {
  std::vector<HardRecord> records{record("joint", 0, 3.0), record("joint", 1, 1.0), record("joint", 2, {})};
  const auto curves = nlohmann::json::parse(report::hard_summary(records, {})).at("curves");
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].at("runs"), 3);
  EXPECT_EQ(curves[0].at("correct_distance_m"), (std::vector<double>{1.0, 3.0}));
}

}  // namespace
}  // namespace mstsl
