#include "drive_report.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/core/angles.hpp"
#include "mstsl/eval/trajectory_error.hpp"
#include "mstsl/io/tum.hpp"
#include "mstsl/viz/picture.hpp"

namespace mstsl::app {
namespace {

std::size_t refuted(const SlamTrack& track) {
  return static_cast<std::size_t>(std::count_if(track.closures.begin(), track.closures.end(),
                                                [](const Closure& c) { return c.refuted; }));
}

/// Against the poses that the log itself has, if it was asked for them.
struct AgainstTruth {
  TrajectoryError absolute;
  RelationErrors local, loops;
};

std::optional<AgainstTruth> against_truth(const MappedDrives& mapped) {
  std::vector<TimedPose> estimated;
  std::vector<Pose2> truth;
  for (std::size_t d = 0; d < mapped.truth.size(); ++d)
    for (const PoseReading& pose : mapped.truth[d]) {
      constexpr double kLongestGap_s = 0.5;
      constexpr double kApart_m = 0.1;  // a truth at 100 Hz has no more to say
      const bool same_place = !truth.empty() && distance(truth.back(), pose.map_T_base) < kApart_m;
      const auto at = mapped.track.drives[d].map_T_base.at(pose.stamp, kLongestGap_s);
      if (!at || same_place) continue;
      estimated.push_back({pose.stamp, *at});
      truth.push_back(pose.map_T_base);
    }
  if (truth.empty()) return std::nullopt;
  return AgainstTruth{trajectory_error(estimated, truth), local_errors(estimated, truth),
                      loop_errors(estimated, truth)};
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

std::string drive_report_text(const MappedDrives& mapped) {
  const SlamTrack& track = mapped.track;
  const GridGeometry& g = mapped.grid.geometry();
  std::string text =
      fmt::format("{:.0f} m driven, {} scans, {} kept; a scan fits those before it to {:.0f} %\n",
                  track.way_m(), track.scans(), track.keyframes.size(), 100 * track.mean_score);
  text += fmt::format(
      "loops: {} closed, {} of them refuted later; {} looked at, {} ambiguous, {} refused by the field, "
      "{} closed only with it\n",
      track.closures.size(), refuted(track), track.loops.looked_at, track.loops.ambiguous,
      track.loops.refused_by_field, track.loops.earlier_by_field);
  text +=
      fmt::format("wheels: ways {:+.1f} %, drift {:+.2f} deg/m, turns {:+.1f} %\n", 100 * track.wheels.scale,
                  degrees(track.wheels.drift_rad_per_m), 100 * track.wheels.turn_scale);
  text += fmt::format(
      "map: {:.1f} x {:.1f} m, {:.0f} m2 free\n", g.columns * g.resolution_m, g.rows * g.resolution_m,
      static_cast<double>(count(mapped.grid, CellState::kFree)) * g.resolution_m * g.resolution_m);
  if (const auto truth = against_truth(mapped)) {
    text += fmt::format("against the true poses: {:.3f} m rms, at most {:.3f} m\n", truth->absolute.rms_m,
                        truth->absolute.max_m);
    text += "  a metre apart: " + relation_text(truth->local) + "\n";
    text += "  over loops:    " + relation_text(truth->loops) + "\n";
  }
  return text;
}

std::string drive_report_json(const MappedDrives& mapped) {
  const SlamTrack& track = mapped.track;
  nlohmann::ordered_json closures = nlohmann::ordered_json::array();
  for (const Closure& c : track.closures)
    closures.push_back({{"from_drive", track.keyframes[c.from].drive},
                        {"from_t", track.keyframes[c.from].stamp.seconds()},
                        {"to_drive", track.keyframes[c.to].drive},
                        {"to_t", track.keyframes[c.to].stamp.seconds()},
                        {"from_T_to", {c.from_T_to.x, c.from_T_to.y, c.from_T_to.yaw}},
                        {"probability", c.probability},
                        {"by_field", c.by_field},
                        {"refuted", c.refuted}});
  nlohmann::ordered_json drives = nlohmann::ordered_json::array();
  for (const DriveTrack& d : track.drives)
    drives.push_back({{"driven_m", d.way_m}, {"scans", d.scans}, {"odometry_breaks", d.breaks}});
  nlohmann::ordered_json report = {{"driven_m", track.way_m()},
                                   {"scans", track.scans()},
                                   {"keyframes", track.keyframes.size()},
                                   {"mean_score", track.mean_score},
                                   {"drives", drives},
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
  if (const auto truth = against_truth(mapped))
    report["against_truth"] = {
        {"true_T_map",
         {truth->absolute.true_T_map.x, truth->absolute.true_T_map.y, truth->absolute.true_T_map.yaw}},
        {"ate_rms_m", truth->absolute.rms_m},
        {"ate_max_m", truth->absolute.max_m},
        {"metre", relation_json(truth->local)},
        {"loops", relation_json(truth->loops)}};
  return report.dump();
}

viz::Canvas draw_ways(const MappedDrives& mapped, const FieldMap* field, const std::string& title) {
  viz::RunPicture picture;
  picture.title = title;
  picture.subtitle = fmt::format("{:.0f} m driven, {} loops closed", mapped.track.way_m(),
                                 mapped.track.closures.size() - refuted(mapped.track));
  picture.field = field;
  constexpr double kApart_m = 0.2;
  for (const DriveTrack& drive : mapped.track.drives)
    for (std::size_t i = 0; i < drive.map_T_base.size(); ++i)
      if (picture.estimated_path.empty() ||
          distance(picture.estimated_path.back(), drive.map_T_base[i].pose) > kApart_m)
        picture.estimated_path.push_back(drive.map_T_base[i].pose);
  picture.start = mapped.track.keyframes.front().map_T_base;
  return viz::draw_run(mapped.grid, picture);
}

Result<void> write_ways(const MappedDrives& mapped, const std::filesystem::path& file) {
  for (std::size_t d = 0; d < mapped.track.drives.size(); ++d) {
    std::filesystem::path name = file;
    if (mapped.track.drives.size() > 1)
      name.replace_filename(fmt::format("{}_{}{}", file.stem().string(), d, file.extension().string()));
    auto writer = io::TumWriter::open(name);
    if (!writer) return writer.error();
    const Trajectory& way = mapped.track.drives[d].map_T_base;
    for (std::size_t i = 0; i < way.size(); ++i)
      if (auto written = writer->write({way[i].stamp, way[i].pose}); !written) return written;
    if (auto closed = writer->close(); !closed) return closed;
  }
  return {};
}

}  // namespace mstsl::app
