#include "mstsl/eval/protocol_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/core/angles.hpp"
#include "mstsl/eval/summary_report.hpp"

#include "eval/paper_figures.hpp"

namespace mstsl {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<double, 12> kErrors_m{0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 1.0, 1.5, 3.0, 10.0};

std::vector<RunEvaluation> runs_of(const ProtocolResult& result, FieldModel model) {
  std::vector<RunEvaluation> runs;
  for (const ProtocolRun& run : result.runs)
    if (run.model == model) runs.push_back(run.evaluation);
  return runs;
}

/// Success of each waypoint's runs, in the order of the waypoints.
std::vector<Rate> by_waypoint(const ProtocolResult& result, FieldModel model) {
  std::vector<Rate> rates;
  for (const ProtocolRun& run : result.runs) {
    if (run.model != model) continue;
    rates.resize(std::max(rates.size(), static_cast<std::size_t>(run.waypoint) + 1));
    rates[static_cast<std::size_t>(run.waypoint)].add(run.evaluation.succeeded());
  }
  return rates;
}

/// The share of runs whose first pose is no farther off than each error.
std::vector<double> error_cdf(const std::vector<RunEvaluation>& runs, const std::vector<double>& errors_m) {
  std::vector<double> first_m;
  for (const RunEvaluation& run : runs)
    if (run.first() != nullptr) first_m.push_back(run.first()->error.position_m);
  return cumulative_share(first_m, errors_m, runs.size());
}

Spread alignment_deg(const ProtocolResult& result) {
  std::vector<double> values;
  for (const ProtocolRun& run : result.runs)
    if (run.model == result.models.front()) values.push_back(degrees(run.alignment_error_rad));
  return spread_of(values);
}

std::string table_one(const ProtocolResult& result) {
  const auto paper = paper_figures(result.world);
  std::string text = fmt::format("Table I: initialisation, K = {}, {} fingerprints\n", result.hypotheses,
                                 result.fingerprints);
  text += fmt::format("  {:<12} {:>9} {:>9} {:>9} {:>9} {:>18}   {}\n", "model", "mean m", "SD m", "min m",
                      "max m", "within 3.0 m", "paper: mean, within 3.0 m");
  for (const FieldModel model : result.models) {
    const Summary summary = summarise(runs_of(result, model));
    const Spread& error = summary.initial_error_m;
    const Interval interval = wilson_interval(summary.initialised);
    text += fmt::format("  {:<12} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>5.1f} % ({:.0f} to {:.0f})",
                        to_string(model), error.mean, error.standard_deviation, error.min, error.max,
                        100 * summary.initialised.share(), 100 * interval.low, 100 * interval.high);
    if (paper)
      text += fmt::format("   {:.3f} m, {:.0f} %", paper->initialisation.at(model).mean_m,
                          100 * paper->initialisation.at(model).success);
    text += "\n";
  }
  const Spread turn = alignment_deg(result);
  text += fmt::format("  alignment after the turn: mean {:.2f} deg, max {:.2f} deg", turn.mean, turn.max);
  return text + (paper ? fmt::format("   (paper: {:.2f} deg)\n\n", paper->alignment_mean_deg) : "\n\n");
}

std::string success_table(const ProtocolResult& result) {
  const auto paper = paper_figures(result.world);
  std::string text = "Fig. 6 a/d: success (first pose within 0.5 m and 10 deg, after no more than 10 m)\n  ";
  text += fmt::format("{:<12} {:>18} ", "model", "all");
  for (std::size_t i = 0; i < by_waypoint(result, result.models.front()).size(); ++i)
    text += fmt::format(" {:>5}", fmt::format("WP{}", i + 1));
  for (const FieldModel model : result.models) {
    const Rate all = summarise(runs_of(result, model)).success;
    const Interval interval = wilson_interval(all);
    text += fmt::format("\n  {:<12} {:>5.1f} % ({:.0f} to {:.0f}) ", to_string(model), 100 * all.share(),
                        100 * interval.low, 100 * interval.high);
    for (const Rate& rate : by_waypoint(result, model))
      text += fmt::format(" {:>5}", fmt::format("{}/{}", rate.hits, rate.of));
  }
  return text + (paper ? fmt::format("\n  paper, gpr   {:>5.1f} %\n\n", 100 * paper->success) : "\n\n");
}

std::string distance_table(const ProtocolResult& result) {
  std::string text = "Fig. 6 b/e: correct localization distance (CLD)\n";
  for (const FieldModel model : result.models) {
    const Spread cld = summarise(runs_of(result, model)).correct_distance_m;
    text += fmt::format("  {:<12} mean {:.2f} m, median {:.2f} m, max {:.2f} m, of {} runs\n",
                        to_string(model), cld.mean, cld.median, cld.max, cld.count);
  }
  return text + "\n";
}

std::string cdf_table(const ProtocolResult& result) {
  const auto paper = paper_figures(result.world);
  std::vector<double> errors(kErrors_m.begin(), kErrors_m.end());
  std::string text = fmt::format("Fig. 6 c/f: share of runs with a first pose within\n  {:<12}", "");
  for (const double error : errors) text += fmt::format(" {:>6}", fmt::format("{:g} m", error));
  for (const FieldModel model : result.models) {
    text += fmt::format("\n  {:<12}", to_string(model));
    for (const double share : error_cdf(runs_of(result, model), errors))
      text += fmt::format(" {:>5.0f}%", 100 * share);
  }
  if (paper)
    text += fmt::format("\n  paper, gpr: {:.0f} % within {:g} m", 100 * paper->error_share, paper->error_m);
  return text + "\n";
}

Json model_json(const ProtocolResult& result, FieldModel model) {
  const std::vector<RunEvaluation> runs = runs_of(result, model);
  const std::vector<double> errors(kErrors_m.begin(), kErrors_m.end());
  Json waypoints = Json::array();
  for (const Rate& rate : by_waypoint(result, model)) waypoints.push_back(rate.share());
  return {{"model", to_string(model)},
          {"summary", Json::parse(to_json(summarise(runs)))},
          {"success_by_waypoint", waypoints},
          {"error_cdf", {{"error_m", errors}, {"share", error_cdf(runs, errors)}}}};
}

Json paper_json(const PaperFigures& paper) {
  Json models;
  for (const auto& [model, figures] : paper.initialisation)
    models[std::string(to_string(model))] = {{"initial_error_mean_m", figures.mean_m},
                                             {"initial_error_sd_m", figures.sd_m},
                                             {"initialised", figures.success}};
  return {{"initialisation", models},
          {"alignment_mean_deg", paper.alignment_mean_deg},
          {"success", paper.success},
          {"error", {{"error_m", paper.error_m}, {"share", paper.error_share}}}};
}

/// A number for a table cell; empty if there is none.
std::string cell(const std::optional<double>& value) { return value ? fmt::format("{:.4f}", *value) : ""; }

}  // namespace

std::string protocol_text(const ProtocolResult& result) {
  return fmt::format("== {}, seed {} ==\n\n", result.world, result.seed) + table_one(result) +
         success_table(result) + distance_table(result) + cdf_table(result);
}

std::string protocol_json(const ProtocolResult& result) {
  const Spread turn = alignment_deg(result);
  Json json{{"world", result.world},
            {"seed", result.seed},
            {"hypotheses", result.hypotheses},
            {"fingerprints", result.fingerprints},
            {"alignment_deg",
             {{"mean", turn.mean}, {"sd", turn.standard_deviation}, {"min", turn.min}, {"max", turn.max}}},
            {"models", Json::array()}};
  for (const FieldModel model : result.models) json["models"].push_back(model_json(result, model));
  if (const auto paper = paper_figures(result.world)) json["paper"] = paper_json(*paper);
  return json.dump(2) + "\n";
}

std::string protocol_runs_csv(const ProtocolResult& result) {
  std::string csv =
      "waypoint,run,model,alignment_error_deg,initial_error_m,initial_first_error_m,success,first_travelled_"
      "m,"
      "first_probability,first_error_m,first_error_deg,cld_m,final_error_m,final_error_deg,times_lost\n";
  for (const ProtocolRun& run : result.runs) {
    const RunEvaluation& e = run.evaluation;
    const JudgedAnswer* first = e.first();
    const auto of_first = [first](double value) { return first ? std::optional(value) : std::nullopt; };
    csv += fmt::format(
        "{},{},{},{:.4f},{},{},{},{},{},{},{},{},{},{},{}\n", run.waypoint + 1, run.run + 1,
        to_string(run.model), degrees(run.alignment_error_rad),
        cell(e.initialisation ? std::optional(e.initialisation->best_error_m) : std::nullopt),
        cell(e.initialisation ? std::optional(e.initialisation->first_error_m) : std::nullopt),
        e.succeeded() ? 1 : 0, cell(of_first(first ? first->travelled_m : 0)),
        cell(of_first(first ? first->probability : 0)), cell(of_first(first ? first->error.position_m : 0)),
        cell(of_first(first ? degrees(first->error.yaw_rad) : 0)), cell(e.correct_distance_m),
        cell(e.last ? std::optional(e.last->error.position_m) : std::nullopt),
        cell(e.last ? std::optional(degrees(e.last->error.yaw_rad)) : std::nullopt), e.times_lost);
  }
  return csv;
}

std::string protocol_cdf_csv(const ProtocolResult& result) {
  std::vector<double> errors;
  for (int i = 0; i <= 200; ++i) errors.push_back(0.01 * i);
  std::vector<std::vector<double>> shares;
  std::string csv = "error_m";
  for (const FieldModel model : result.models) {
    csv += fmt::format(",{}", to_string(model));
    shares.push_back(error_cdf(runs_of(result, model), errors));
  }
  csv += "\n";
  for (std::size_t i = 0; i < errors.size(); ++i) {
    csv += fmt::format("{:.2f}", errors[i]);
    for (const auto& model : shares) csv += fmt::format(",{:.4f}", model[i]);
    csv += "\n";
  }
  return csv;
}

}  // namespace mstsl
