#include "hard_drawings.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "mstsl/eval/hard_report.hpp"
#include "mstsl/viz/plot.hpp"

namespace mstsl::app {
namespace {

bool is_total(const HardRow& row) { return row.world == "*" && row.disturbance == "*"; }

/// Success of each method, where the rows of interest are told apart by one of their names.
viz::BarPlot success_by(const std::vector<HardRow>& rows, const char* what, std::string HardRow::*name,
                        std::string HardRow::*other) {
  viz::BarPlot plot{
      fmt::format("right pose within 10 m, by {} (95 % intervals)", what), "", {"%", 0.0, 100.0}, {}, {}};
  for (const HardRow& row : rows) {
    if (row.*name == "*" || row.*other != "*") continue;
    if (std::ranges::find(plot.categories, row.*name) == plot.categories.end())
      plot.categories.push_back(row.*name);
    auto group = std::ranges::find(plot.groups, row.method, &viz::Group::name);
    if (group == plot.groups.end()) group = plot.groups.insert(group, viz::Group{row.method, {}, {}});
    const Interval interval = wilson_interval(row.success);
    group->values.push_back(100 * row.success.share());
    group->bounds.push_back({100 * interval.low, 100 * interval.high});
  }
  return plot;
}

/// How soon it comes about: the share of the runs in which it had, over the way driven.
viz::CurvePlot soon(const std::vector<HardRow>& rows, const char* title,
                    std::vector<double> HardRow::*distances_m,
                    const std::function<std::size_t(const HardRow&)>& of) {
  viz::CurvePlot plot{title, {"driven, m", 0.0, 10.0}, {"share of runs", 0.0, 1.0}, {}, {}};
  for (const HardRow& row : rows)
    if (is_total(row)) plot.series.push_back(viz::distribution(row.method, row.*distances_m, of(row)));
  return plot;
}

viz::BoxPlot errors(const std::vector<HardRow>& rows) {
  viz::BoxPlot plot{"error of right runs' poses", {"cm", 0.0, 20.0}, {}};
  for (const HardRow& row : rows) {
    if (!is_total(row)) continue;
    viz::Group& group = plot.groups.emplace_back(viz::Group{row.method, {}, {}});
    for (const double error_m : row.error_m) group.values.push_back(100 * error_m);
  }
  return plot;
}

viz::CurvePlot reliability(const std::vector<HardRow>& rows) {
  viz::CurvePlot plot{"reliability of first poses: right as often as claimed",
                      {"claimed", 0.0, 1.0},
                      {"right", 0.0, 1.0},
                      {{"as claimed", {{0.0, 0.0}, {1.0, 1.0}}, viz::SeriesKind::kLine}},
                      {}};
  for (const HardRow& row : rows) {
    if (!is_total(row)) continue;
    viz::Series& series = plot.series.emplace_back(viz::Series{row.method, {}, viz::SeriesKind::kPoints});
    for (const ReliabilityBin& bin : row.first_answers.bins)
      if (bin.right.of > 0) series.points.push_back({bin.mean_claim, bin.right.share()});
  }
  return plot;
}

}  // namespace

Result<void> draw_hard_figures(const std::vector<HardRecord>& records, const std::string& set,
                               const std::filesystem::path& folder) {
  const std::vector<HardRow> rows = hard_rows(records);
  std::vector<std::pair<const char*, viz::Canvas>> figures;
  figures.emplace_back("worlds",
                       viz::draw_plot(success_by(rows, "world", &HardRow::world, &HardRow::disturbance)));
  figures.emplace_back("disturbances", viz::draw_plot(success_by(rows, "disturbance", &HardRow::disturbance,
                                                                 &HardRow::world)));
  figures.emplace_back(
      "distance", viz::draw_plot(soon(rows, "driven until the pose was right", &HardRow::correct_distance_m,
                                      [](const HardRow& row) { return row.runs; })));
  figures.emplace_back("errors", viz::draw_plot(errors(rows)));
  figures.emplace_back("reliability", viz::draw_plot(reliability(rows)));
  if (std::ranges::any_of(rows, [](const HardRow& row) { return row.noticed_3m.of > 0; })) {
    const auto carried = [](const HardRow& row) { return row.noticed_3m.of; };
    figures.emplace_back("noticed", viz::draw_plot(soon(rows, "driven until a carry was noticed",
                                                        &HardRow::noticed_m, carried)));
    figures.emplace_back("recovered", viz::draw_plot(soon(rows, "driven until the pose was right again",
                                                          &HardRow::recovered_m, carried)));
  }
  for (const auto& [name, canvas] : figures)
    if (auto saved = canvas.save(folder / fmt::format("hard_{}_{}.svg", set, name)); !saved) return saved;
  return {};
}

}  // namespace mstsl::app
