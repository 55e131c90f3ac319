#include "mstsl/eval/summary_report.hpp"

#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

using Json = nlohmann::ordered_json;

std::string line(std::string_view what, const Rate& rate) {
  const Interval interval = wilson_interval(rate);
  return fmt::format("  {:<44} {:>5.1f} %  ({}/{}, 95 %: {:.1f} to {:.1f} %)\n", what, 100 * rate.share(),
                     rate.hits, rate.of, 100 * interval.low, 100 * interval.high);
}

std::string line(std::string_view what, const Spread& spread, double scale, std::string_view unit) {
  if (spread.count == 0) return fmt::format("  {:<44} none\n", what);
  return fmt::format("  {:<44} {:>7.3f} {} (median {:.3f}, 90 % {:.3f}, max {:.3f})\n", what,
                     scale * spread.mean, unit, scale * spread.median, scale * spread.p90,
                     scale * spread.max);
}

std::string line(std::string_view what, const Calibration& calibration) {
  std::string text = fmt::format("  {} (Brier {:.4f})\n", what, calibration.brier);
  for (const ReliabilityBin& bin : calibration.bins)
    text += fmt::format("    claimed {:.3f} to {:.3f}, mean {:.3f}: right {:.3f} ({}/{})\n", bin.low,
                        bin.high, bin.mean_claim, bin.right.share(), bin.right.hits, bin.right.of);
  return text;
}

Json to_json(const Rate& rate) {
  const Interval interval = wilson_interval(rate);
  return {{"hits", rate.hits},
          {"of", rate.of},
          {"share", rate.share()},
          {"wilson_95", {interval.low, interval.high}}};
}

Json to_json(const Spread& spread) {
  return {
      {"count", spread.count}, {"mean", spread.mean},     {"standard_deviation", spread.standard_deviation},
      {"min", spread.min},     {"median", spread.median}, {"p90", spread.p90},
      {"max", spread.max}};
}

Json to_json(const Calibration& calibration) {
  Json bins = Json::array();
  for (const ReliabilityBin& bin : calibration.bins)
    bins.push_back({{"low", bin.low},
                    {"high", bin.high},
                    {"mean_claim", bin.mean_claim},
                    {"right", to_json(bin.right)}});
  return {{"brier", calibration.brier},
          {"wrong_at_0.99", to_json(calibration.wrong_at_99)},
          {"wrong_at_0.999", to_json(calibration.wrong_at_999)},
          {"bins", bins}};
}

}  // namespace

std::string to_text(const Summary& summary) {
  const double to_deg = degrees(1.0);
  std::string text = fmt::format("{} run{}\n", summary.runs, summary.runs == 1 ? "" : "s");
  text += line("success (first pose right, within 10 m)", summary.success);
  text += line("  tight (0.2 m, 3 deg)", summary.tight_success);
  text += line("right at the end", summary.final_success);
  text += line("  tight", summary.final_tight);
  text += line("a pose was given", summary.answered);
  text += line("initialised (a hypothesis within 3.0 m)", summary.initialised);
  text += line("  the most probable hypothesis", summary.initialised_first);
  text += line("runs with a wrong pose claimed at 0.99", summary.runs_wrong_at_99);
  text += line("runs with a wrong pose claimed at 0.999", summary.runs_wrong_at_999);
  text += line("initial error, best hypothesis", summary.initial_error_m, 1.0, "m");
  text += line("distance to the right answer (CLD)", summary.correct_distance_m, 1.0, "m");
  text += line("error of the first pose", summary.first_error_m, 1.0, "m");
  text += line("", summary.first_error_yaw_rad, to_deg, "deg");
  text += line("error at the end", summary.final_error_m, 1.0, "m");
  text += line("", summary.final_error_yaw_rad, to_deg, "deg");
  text += line("probabilities of first poses", summary.first_answers);
  text += line("probabilities of all poses", summary.all_answers);
  if (summary.covariances.poses > 0)
    text += fmt::format("  covariances: NEES mean {:.2f} (3 if true), median {:.2f} (2.37)\n",
                        summary.covariances.mean_nees, summary.covariances.median_nees) +
            line("right poses within their 95 % ellipsoid", summary.covariances.within_95);
  if (summary.times_lost > 0) text += fmt::format("  lost {} times\n", summary.times_lost);
  if (summary.without_truth > 0)
    text += fmt::format("  {} estimates lie outside the truth's time and were not judged\n",
                        summary.without_truth);
  return text;
}

std::string to_json(const Summary& summary) {
  const Json json{{"runs", summary.runs},
                  {"success", to_json(summary.success)},
                  {"tight_success", to_json(summary.tight_success)},
                  {"final_success", to_json(summary.final_success)},
                  {"final_tight", to_json(summary.final_tight)},
                  {"answered", to_json(summary.answered)},
                  {"initialised", to_json(summary.initialised)},
                  {"initialised_first", to_json(summary.initialised_first)},
                  {"runs_wrong_at_0.99", to_json(summary.runs_wrong_at_99)},
                  {"runs_wrong_at_0.999", to_json(summary.runs_wrong_at_999)},
                  {"initial_error_m", to_json(summary.initial_error_m)},
                  {"correct_distance_m", to_json(summary.correct_distance_m)},
                  {"first_error_m", to_json(summary.first_error_m)},
                  {"first_error_yaw_rad", to_json(summary.first_error_yaw_rad)},
                  {"final_error_m", to_json(summary.final_error_m)},
                  {"final_error_yaw_rad", to_json(summary.final_error_yaw_rad)},
                  {"first_answers", to_json(summary.first_answers)},
                  {"all_answers", to_json(summary.all_answers)},
                  {"nees",
                   {{"poses", summary.covariances.poses},
                    {"mean", summary.covariances.mean_nees},
                    {"median", summary.covariances.median_nees},
                    {"within_95", to_json(summary.covariances.within_95)}}},
                  {"times_lost", summary.times_lost},
                  {"without_truth", summary.without_truth}};
  return json.dump();
}

}  // namespace mstsl
