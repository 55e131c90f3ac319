#include "drive_report.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/core/angles.hpp"
#include "mstsl/eval/trajectory_error.hpp"

namespace mstsl::app {
namespace {

std::size_t refuted(const SlamTrack& track) {
  return static_cast<std::size_t>(
      std::count_if(track.closures.begin(), track.closures.end(), [](const Closure& c) { return c.refuted; }));
}

/// Against the poses that the log itself has, if it was asked for them.
struct AgainstTruth {
  TrajectoryError absolute;
  RelationErrors local, loops;
};

std::optional<AgainstTruth> against_truth(const MappedDrive& drive) {
  std::vector<TimedPose> estimated;
  std::vector<Pose2> truth;
  for (const PoseReading& pose : drive.truth) {
    constexpr double kLongestGap_s = 0.5;
    const auto at = drive.track.map_T_base.at(pose.stamp, kLongestGap_s);
    if (!at) continue;
    estimated.push_back({pose.stamp, *at});
    truth.push_back(pose.map_T_base);
  }
  if (truth.empty()) return std::nullopt;
  return AgainstTruth{trajectory_error(estimated, truth), local_errors(estimated, truth), loop_errors(estimated, truth)};
}

std::string relation_text(const RelationErrors& errors) {
  return fmt::format("{:.4f} +- {:.4f} m, {:.3f} +- {:.3f} deg ({} relations)", errors.translation_m.mean,
                     errors.translation_m.standard_deviation, errors.rotation_deg.mean,
                     errors.rotation_deg.standard_deviation, errors.translation_m.count);
}

nlohmann::ordered_json relation_json(const RelationErrors& errors) {
  return {{"count", errors.translation_m.count},
          {"translation_mean_m", errors.translation_m.mean},
          {"translation_sd_m", errors.translation_m.standard_deviation},
          {"rotation_mean_deg", errors.rotation_deg.mean},
          {"rotation_sd_deg", errors.rotation_deg.standard_deviation}};
}

}  // namespace

std::string drive_report_text(const MappedDrive& drive) {
  const SlamTrack& track = drive.track;
  const GridGeometry& g = drive.grid.geometry();
  std::string text = fmt::format("{:.0f} m driven, {} scans, {} kept; a scan fits those before it to {:.0f} %\n", track.way_m,
                                 track.scans, track.keyframes.size(), 100 * track.mean_score);
  text += fmt::format("loops: {} closed, {} of them refuted later; {} looked at, {} ambiguous, {} refused by the field, "
                      "{} closed only with it\n",
                      track.closures.size(), refuted(track), track.loops.looked_at, track.loops.ambiguous,
                      track.loops.refused_by_field, track.loops.earlier_by_field);
  text += fmt::format("wheels: ways {:+.1f} %, drift {:+.2f} deg/m, turns {:+.1f} %\n", 100 * track.wheels.scale,
                      degrees(track.wheels.drift_rad_per_m), 100 * track.wheels.turn_scale);
  text += fmt::format("map: {:.1f} x {:.1f} m, {:.0f} m2 free\n", g.columns * g.resolution_m, g.rows * g.resolution_m,
                      static_cast<double>(count(drive.grid, CellState::kFree)) * g.resolution_m * g.resolution_m);
  if (const auto truth = against_truth(drive)) {
    text += fmt::format("against the true poses: {:.3f} m rms, at most {:.3f} m\n", truth->absolute.rms_m, truth->absolute.max_m);
    text += "  a metre apart: " + relation_text(truth->local) + "\n";
    text += "  over loops:    " + relation_text(truth->loops) + "\n";
  }
  return text;
}

std::string drive_report_json(const MappedDrive& drive) {
  const SlamTrack& track = drive.track;
  nlohmann::ordered_json closures = nlohmann::ordered_json::array();
  for (const Closure& c : track.closures)
    closures.push_back({{"from_t", track.keyframes[c.from].stamp.seconds()},
                        {"to_t", track.keyframes[c.to].stamp.seconds()},
                        {"from_T_to", {c.from_T_to.x, c.from_T_to.y, c.from_T_to.yaw}},
                        {"probability", c.probability},
                        {"by_field", c.by_field},
                        {"refuted", c.refuted}});
  nlohmann::ordered_json report = {{"driven_m", track.way_m},
                                         {"scans", track.scans},
                                         {"keyframes", track.keyframes.size()},
                                         {"mean_score", track.mean_score},
                                         {"odometry_breaks", track.breaks},
                                         {"wheels",
                                          {{"scale", track.wheels.scale},
                                           {"drift_rad_per_m", track.wheels.drift_rad_per_m},
                                           {"turn_scale", track.wheels.turn_scale}}},
                                         {"loops",
                                          {{"looked_at", track.loops.looked_at},
                                           {"closed", track.closures.size()},
                                           {"refuted", refuted(track)},
                                           {"ambiguous", track.loops.ambiguous},
                                           {"refused_by_field", track.loops.refused_by_field},
                                           {"closed_only_with_field", track.loops.earlier_by_field}}},
                                         {"closures", closures}};
  if (const auto truth = against_truth(drive))
    report["against_truth"] = {{"ate_rms_m", truth->absolute.rms_m},
                               {"ate_max_m", truth->absolute.max_m},
                               {"metre", relation_json(truth->local)},
                               {"loops", relation_json(truth->loops)}};
  return report.dump();
}

}  // namespace mstsl::app
