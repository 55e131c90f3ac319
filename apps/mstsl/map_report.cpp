#include "map_report.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "report_words.hpp"

namespace mstsl::app {
namespace {

/// What became of the field readings, for those that were not used.
std::array<std::pair<const char*, std::uint64_t>, 6> dropped(const CollectionReport& r) {
  return {{{"field readings not finite", r.not_finite},
           {"field readings out of order", r.out_of_order},
           {"field readings without a pose", r.without_pose},
           {"field readings in a gap of the poses", r.in_pose_gap},
           {"field readings at a jump of the pose", r.at_pose_jump},
           {"poses not finite or out of order", r.bad_poses}}};
}

struct Cells {
  std::size_t valued = 0, supported = 0;
};
Cells count_cells(const FieldMap& map) {
  Cells cells;
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    cells.valued += map.has_value(map.geometry.cell(i)) ? 1 : 0;
    cells.supported += map.supported[i];
  }
  return cells;
}

std::string percents(const Eigen::Array3d& shares) {
  return fmt::format("{:.0f} {:.0f} {:.0f} %", 100 * shares(0), 100 * shares(1), 100 * shares(2));
}

std::string score_line(const char* what, const HeldOutScore& before, const HeldOutScore& after) {
  return fmt::format(
      "  {}: rms {}, within 1 sigma {}, within 2 sigma {} (uncalibrated {} and {}); {} fingerprints\n", what,
      three(after.rms_uT, " uT"), percents(after.within_1_sigma), percents(after.within_2_sigma),
      percents(before.within_1_sigma), percents(before.within_2_sigma), after.errors);
}

std::string bias_text(const SurveyAnalysis& analysis) {
  std::string text;
  for (std::size_t s = 0; s < analysis.bias.sessions.size(); ++s) {
    const SessionBias& bias = analysis.bias.sessions[s];
    text += fmt::format("bias of log {} in base_link, x y: {:.2f} {:.2f} +- {:.2f} {:.2f} uT, {}{}\n", s + 1,
                        bias.base_bias_uT.x(), bias.base_bias_uT.y(), bias.sd_uT.x(), bias.sd_uT.y(),
                        bias.significant ? "significant" : "not significant",
                        analysis.bias_removed ? ", removed" : ", left in");
    if (bias.has_soft_iron)
      text += fmt::format(
          "soft iron of log {}: horizontally x {:.3f} y {:.3f} shear {:.3f}, into z {:.3f} {:.3f} (+- "
          "{:.3f})\n",
          s + 1, bias.soft_iron(0, 0), bias.soft_iron(1, 1), bias.soft_iron(0, 1), bias.soft_iron(2, 0),
          bias.soft_iron(2, 1), bias.soft_iron_sd);
  }
  return text;
}

std::array<std::array<double, 3>, 3> rows(const Eigen::Matrix3d& m) {
  const auto row = [&m](int r) { return list(m.row(r).transpose().array()); };
  return {row(0), row(1), row(2)};
}

nlohmann::ordered_json to_json(const HeldOutScore& score) {
  return {{"fingerprints", score.errors},
          {"rms_uT", list(score.rms_uT)},
          {"within_1_sigma", list(score.within_1_sigma)},
          {"within_2_sigma", list(score.within_2_sigma)}};
}

nlohmann::ordered_json bias_json(const SurveyAnalysis& analysis) {
  nlohmann::ordered_json sessions = nlohmann::ordered_json::array();
  for (const SessionBias& bias : analysis.bias.sessions)
    sessions.push_back({{"base_bias_uT", list(bias.base_bias_uT.array())},
                        {"sd_uT", list(bias.sd_uT.array())},
                        {"significant", bias.significant},
                        {"soft_iron", rows(bias.soft_iron)},
                        {"soft_iron_sd", bias.soft_iron_sd}});
  return {{"pairs", analysis.bias.pairs}, {"removed", analysis.bias_removed}, {"logs", sessions}};
}

std::string kernel_text(const SurveyAnalysis& analysis) {
  if (!analysis.kernel_comparison) return {};
  const KernelComparison& c = *analysis.kernel_comparison;
  return fmt::format(
      "covariance: {}; on held-out lanes a harmonic one (steel {}, depth {:.2f} m) has rms {} instead of {}, "
      "log density {:+.2f} +- {:.2f} a fingerprint\n",
      analysis.harmonic ? "harmonic" : "squared exponential", to_string(c.harmonic.side), c.harmonic.depth_m,
      three(c.rms_harmonic_uT, " uT"), three(c.rms_independent_uT, " uT"), c.gain, c.gain_sd);
}

nlohmann::ordered_json kernel_json(const SurveyAnalysis& analysis) {
  nlohmann::ordered_json json{{"chosen", analysis.harmonic ? "harmonic" : "squared-exponential"}};
  if (!analysis.kernel_comparison) return json;
  const KernelComparison& c = *analysis.kernel_comparison;
  json["harmonic"] = {{"steel", to_string(c.harmonic.side)},
                      {"depth_m", c.harmonic.depth_m},
                      {"signal_sd_uT", c.harmonic.signal_sd_uT},
                      {"noise_sd_uT", list(c.harmonic.noise_sd_uT)}};
  json["log_density_gain"] = c.gain;
  json["log_density_gain_sd"] = c.gain_sd;
  json["rms_harmonic_uT"] = list(c.rms_harmonic_uT);
  json["rms_squared_exponential_uT"] = list(c.rms_independent_uT);
  return json;
}

std::string check_text(const CheckedLog& log) {
  const FieldCheck& check = log.check;
  if (check.score.errors == 0)
    return fmt::format("  {}: none of its {} fingerprints lies on the map\n", log.name, check.without_value);
  return fmt::format(
      "  {}: rms {}, mean error {}, within 1 sigma {}, 2 sigma {}; {} fingerprints, {} off the map\n",
      log.name, three(check.score.rms_uT, " uT"), three(check.mean_error_uT, " uT"),
      percents(check.score.within_1_sigma), percents(check.score.within_2_sigma), check.score.errors,
      check.without_value);
}

std::string tracks_text(const std::vector<SurveyTrack>& tracks) {
  std::string text;
  for (const SurveyTrack& track : tracks)
    text += fmt::format(
        "tracked {:.0f} m by {} scans, {:.0f} % of their points on walls; places known to {:.1f} cm (at "
        "worst "
        "{:.1f} cm)\n",
        track.way_m, track.scans, 100 * track.mean_score, 100 * track.typical_sd_m, 100 * track.worst_sd_m);
  return text;
}

nlohmann::ordered_json to_json(const SurveyTrack& track) {
  return {{"way_m", track.way_m},
          {"scans", track.scans},
          {"mean_score", track.mean_score},
          {"typical_sd_m", track.typical_sd_m},
          {"worst_sd_m", track.worst_sd_m}};
}

nlohmann::ordered_json to_json(const CheckedLog& log) {
  nlohmann::ordered_json json{{"log", log.name}, {"off_the_map", log.check.without_value}};
  json.update(to_json(log.check.score));
  json["mean_error_uT"] = list(log.check.mean_error_uT);
  return json;
}

}  // namespace

std::string map_report_text(const SurveyLogs& logs, const SurveyAnalysis& analysis, const FieldMap& map,
                            const std::vector<CheckedLog>& checks) {
  const FieldHyperparameters& h = analysis.hyperparameters.values;
  const Cells cells = count_cells(map);
  std::string text = fmt::format("{} fingerprints from {} field readings, {} outliers dropped\n",
                                 logs.fingerprints.size(), logs.collected.readings, analysis.outliers);
  text += tracks_text(logs.tracks);
  for (const auto& [what, count] : dropped(logs.collected))
    if (count > 0) text += fmt::format("  {}: {}\n", what, count);
  for (const auto& [what, count] : logs.problems) text += fmt::format("  {}: {}\n", what, count);
  if (const auto distrusted = map.hyperparameters.find("distrusted_fingerprints");
      distrusted != map.hyperparameters.end() && distrusted->second > 0)
    text +=
        fmt::format("{:.0f} fingerprints disagree with those around them and are trusted less than half\n",
                    distrusted->second);
  text += bias_text(analysis);
  text += fmt::format(
      "length scale {:.2f} m; x y z: mean {}, signal {}, noise {} (from {} fingerprints in {} blocks)\n",
      h.length_scale_m(0), three(h.mean_uT, " uT"), three(h.signal_sd_uT, " uT"), three(h.noise_sd_uT, " uT"),
      analysis.hyperparameters.samples, analysis.hyperparameters.blocks);
  text += kernel_text(analysis);
  if (analysis.model == FieldModel::kBilinear)
    text += fmt::format("lattice of {:.2f} m\n", analysis.bilinear_spacing_m);
  text += "held-out lanes, x y z:\n";
  text +=
      score_line("over the same floor", analysis.held_out.same_floor_before, analysis.held_out.same_floor);
  text +=
      score_line("between lanes", analysis.held_out.between_lanes_before, analysis.held_out.between_lanes);
  text += fmt::format("a later reading differs by {} where the map is sure and the field of usual strength\n",
                      three(analysis.calibration.of_variance.reading_variance_uT2().sqrt(), " uT"));
  if (!checks.empty()) text += "other drives, x y z:\n";
  for (const CheckedLog& log : checks) text += check_text(log);
  text += fmt::format("{} x {} cells of {} m, {} with a value, {} near a fingerprint\n", map.geometry.columns,
                      map.geometry.rows, map.geometry.resolution_m, cells.valued, cells.supported);
  text += coverage_text(map);
  text += drives_text(map);
  return text;
}

std::string map_report_json(const SurveyLogs& logs, const SurveyAnalysis& analysis, const FieldMap& map,
                            const std::vector<CheckedLog>& checks) {
  const Cells cells = count_cells(map);
  nlohmann::ordered_json json{{"model", to_string(map.model)},
                              {"fingerprints", logs.fingerprints.size()},
                              {"field_readings", logs.collected.readings},
                              {"outliers", analysis.outliers}};
  for (const auto& [what, count] : dropped(logs.collected)) json["problems"][what] = count;
  for (const auto& [what, count] : logs.problems) json["problems"][what] = count;
  for (const SurveyTrack& track : logs.tracks) json["tracked"].push_back(to_json(track));
  json["bias"] = bias_json(analysis);
  json["hyperparameters"] = map.hyperparameters;
  if (analysis.model == FieldModel::kGpr) json["kernel"] = kernel_json(analysis);
  json["learned_from"] = {{"fingerprints", analysis.hyperparameters.samples},
                          {"blocks", analysis.hyperparameters.blocks}};
  json["held_out"] = {{"same_floor", to_json(analysis.held_out.same_floor)},
                      {"same_floor_uncalibrated", to_json(analysis.held_out.same_floor_before)},
                      {"between_lanes", to_json(analysis.held_out.between_lanes)},
                      {"between_lanes_uncalibrated", to_json(analysis.held_out.between_lanes_before)}};
  if (!checks.empty()) json["checks"] = nlohmann::ordered_json::array();
  for (const CheckedLog& log : checks) json["checks"].push_back(to_json(log));
  json["cells"] = {{"columns", map.geometry.columns},
                   {"rows", map.geometry.rows},
                   {"resolution_m", map.geometry.resolution_m},
                   {"with_value", cells.valued},
                   {"supported", cells.supported}};
  json["coverage"] = coverage_json(map);
  json["drives"] = drives_json(map);
  json["warnings"] = analysis.warnings;
  return json.dump() + "\n";
}

}  // namespace mstsl::app
