#include "paper_drawings.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "mstsl/viz/picture.hpp"
#include "mstsl/viz/plot.hpp"

namespace mstsl::app {
namespace {

std::string title_of(const ProtocolResult& result, const char* what) {
  return fmt::format("{}: {}", result.world, what);
}

/// The first estimate that is a pose, and the first that has hypotheses.
struct Case {
  const RunTrace* trace;
  const TracedMethod* method;
  const Estimate *begin, *end;
};

/// The first case in which the first model's localizer chose between several hypotheses.
std::optional<Case> telling_case(const ProtocolResult& result) {
  for (const RunTrace& trace : result.traces) {
    const std::vector<Estimate>& estimates = trace.methods.front().estimates;
    const auto begin =
        std::ranges::find_if(estimates, [](const Estimate& e) { return e.hypotheses.size() > 1; });
    const auto end =
        std::find_if(begin, estimates.end(), [](const Estimate& e) { return e.map_T_base.has_value(); });
    if (end != estimates.end()) return Case{&trace, &trace.methods.front(), &*begin, &*end};
  }
  return std::nullopt;
}

/// Fig. 4. Which of the first hypotheses the answer came from: the robot's true motion leads back to it.
viz::Canvas draw_case(const ProtocolResult& result, const Case& shown) {
  viz::RunPicture picture;
  picture.title = title_of(result, "the hypotheses of one case (paper Fig. 4)");
  constexpr double kGap_s = 1.0;
  const auto first = shown.trace->truth.at(shown.begin->stamp, kGap_s);
  const auto last = shown.trace->truth.at(shown.end->stamp, kGap_s);
  const Pose2 motion = first && last ? between(*first, *last) : Pose2{};
  const Pose2 came_from = *shown.end->map_T_base * inverse(motion);
  const std::vector<Hypothesis>& hypotheses = shown.begin->hypotheses;
  const auto survivor = std::ranges::min_element(
      hypotheses, {}, [&](const Hypothesis& h) { return distance(h.map_T_base, came_from); });
  for (const Hypothesis& h : hypotheses)
    picture.hypotheses.push_back({h.map_T_base, h.weight, &h != &*survivor});
  for (const Estimate& e : shown.method->estimates)
    if (e.map_T_base) picture.estimated_path.push_back(*e.map_T_base);
  const Trajectory& truth = shown.trace->truth;
  for (std::size_t i = 0; i < truth.size(); ++i) picture.true_path.push_back(truth[i].pose);
  picture.subtitle =
      fmt::format("{}, {}: {} hypotheses at first; one is left after {:.2f} m", shown.trace->name,
                  shown.method->name, hypotheses.size(), shown.end->travelled_m);
  if (!picture.true_path.empty()) picture.start = picture.true_path.front();
  return viz::draw_run(result.place->occupancy, picture);
}

/// Fig. 5.
viz::Canvas draw_waypoints(const ProtocolResult& result) {
  viz::RunPicture picture;
  picture.title = title_of(result, "the field and the waypoints (paper Fig. 5)");
  picture.subtitle =
      fmt::format("{} fingerprints, {}", result.fingerprints, to_string(result.models.front()));
  picture.field = &result.place->field;
  for (std::size_t i = 0; i < result.waypoints_m.size(); ++i)
    picture.places.push_back({result.waypoints_m[i], fmt::format("WP{}", i + 1)});
  return viz::draw_run(result.place->occupancy, picture);
}

/// Fig. 6: success by waypoint (a, d), CLD (b, e), errors (c, f).
struct Figure6 {
  viz::BarPlot success;
  viz::BoxPlot distance;
  viz::CurvePlot error;
};

Figure6 figure6(const ProtocolResult& result) {
  Figure6 figure{{title_of(result, "success by waypoint (paper Fig. 6 a, d)"), "", {"%", 0.0, 100.0}, {}, {}},
                 {title_of(result, "correct localization distance (paper Fig. 6 b, e)"), {"m", 0.0, {}}, {}},
                 {title_of(result, "error of the first pose (paper Fig. 6 c, f)"),
                  {"m", 0.0, 2.0},
                  {"share of runs", 0.0, 1.0},
                  {},
                  {{0.5, "a right pose"}}}};
  const std::size_t waypoints = result.waypoints_m.size();
  for (std::size_t i = 0; i < waypoints; ++i) figure.success.categories.push_back(fmt::format("WP{}", i + 1));
  for (const FieldModel model : result.models) {
    std::vector<Rate> rates(waypoints);
    std::vector<double> cld_m, error_m;
    std::size_t runs = 0;
    for (const ProtocolRun& run : result.runs) {
      if (run.model != model) continue;
      ++runs;
      rates[static_cast<std::size_t>(run.waypoint)].add(run.evaluation.succeeded());
      if (run.evaluation.correct_distance_m) cld_m.push_back(*run.evaluation.correct_distance_m);
      if (const JudgedAnswer* first = run.evaluation.first()) error_m.push_back(first->error.position_m);
    }
    const std::string name(to_string(model));
    viz::Group& bars = figure.success.groups.emplace_back(viz::Group{name, {}, {}});
    for (const Rate& rate : rates) {
      const Interval interval = wilson_interval(rate);
      bars.values.push_back(100 * rate.share());
      bars.bounds.push_back({100 * interval.low, 100 * interval.high});
    }
    figure.distance.groups.push_back({name, std::move(cld_m), {}});
    figure.error.series.push_back(viz::distribution(name, std::move(error_m), runs));
  }
  return figure;
}

}  // namespace

Result<void> draw_paper_figures(const ProtocolResult& result, const std::filesystem::path& folder) {
  const auto file = [&](const char* figure) {
    return folder / fmt::format("paper_{}_{}.svg", result.world, figure);
  };
  const Figure6 figure = figure6(result);
  if (auto saved = viz::draw_plot(figure.success).save(file("fig6a")); !saved) return saved;
  if (auto saved = viz::draw_plot(figure.distance).save(file("fig6b")); !saved) return saved;
  if (auto saved = viz::draw_plot(figure.error).save(file("fig6c")); !saved) return saved;
  if (auto saved = draw_waypoints(result).save(file("fig5")); !saved) return saved;
  const std::optional<Case> shown = telling_case(result);
  return shown ? draw_case(result, *shown).save(file("fig4")) : Result<void>{};
}

}  // namespace mstsl::app
