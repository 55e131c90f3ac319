#include "update_report.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/core/angles.hpp"

#include "report_words.hpp"

namespace mstsl::app {
namespace {

/// The most changed first.
std::vector<FieldChange> by_size(std::vector<FieldChange> changes) {
  std::ranges::stable_sort(changes, std::ranges::greater{},
                           [](const FieldChange& c) { return c.rms_uT.matrix().norm(); });
  return changes;
}

std::string found_text(const FoundStart& found) {
  const Pose2& pose = found.anchor.map_T_base;
  return fmt::format("  found after {:.1f} m at ({:.2f}, {:.2f}) m, {:.0f} deg\n", found.travelled_m, pose.x,
                     pose.y, degrees(pose.yaw));
}

std::string changes_text(const DriveComparison& drive) {
  constexpr std::size_t kMost = 10;
  if (drive.changes.empty()) return "  nothing has changed along it\n";
  std::string text = fmt::format("  changed along {:.1f} m of its {:.1f} m, in {} places:\n", drive.changed_m,
                                 drive.compared_m + drive.new_m, drive.changes.size());
  const std::vector<FieldChange> changes = by_size(drive.changes);
  for (std::size_t i = 0; i < std::min(kMost, changes.size()); ++i)
    text += fmt::format("    ({:.2f}, {:.2f}) m: {} rms along {:.1f} m\n", changes[i].center_m.x(),
                        changes[i].center_m.y(), three(changes[i].rms_uT, " uT"), changes[i].length_m);
  if (changes.size() > kMost) text += fmt::format("    and {} more\n", changes.size() - kMost);
  return text;
}

nlohmann::ordered_json to_json(const DriveComparison& drive) {
  nlohmann::ordered_json json{{"rms_uT", list(drive.check.score.rms_uT)},
                              {"within_1_sigma", list(drive.check.score.within_1_sigma)},
                              {"within_2_sigma", list(drive.check.score.within_2_sigma)},
                              {"usual_sigmas", drive.usual_sigmas},
                              {"unexplained_share", drive.unexplained},
                              {"base_bias_uT", list(drive.base_bias_uT.array())},
                              {"compared_m", drive.compared_m},
                              {"new_ground_m", drive.new_m},
                              {"changed_m", drive.changed_m},
                              {"changes", nlohmann::ordered_json::array()}};
  for (const FieldChange& change : by_size(drive.changes))
    json["changes"].push_back({{"x_m", change.center_m.x()},
                               {"y_m", change.center_m.y()},
                               {"length_m", change.length_m},
                               {"rms_uT", list(change.rms_uT)}});
  return json;
}

}  // namespace

std::string name_of(const LocatedDrives& drives, const DriveComparison& drive, std::size_t first) {
  return drives.survey.drives[static_cast<std::size_t>(drive.session) - first].name;
}

std::string update_report_text(const LocatedDrives& drives, const FieldUpdate& update,
                               const std::optional<FieldMap>& made, std::size_t first) {
  std::string text;
  for (const DriveComparison& drive : update.drives) {
    if (!drive.refused.empty()) continue;  // a warning says so
    text += name_of(drives, drive, first) + "\n";
    if (!drives.found.empty())
      text += found_text(drives.found[static_cast<std::size_t>(drive.session) - first]);
    text += fmt::format(
        "  {:.1f} m over known ground, {:.1f} m over new; foretold with rms {}, typically {:.1f} standard "
        "deviations; bias against the map {}\n",
        drive.compared_m, drive.new_m, three(drive.check.score.rms_uT, " uT"), drive.usual_sigmas,
        three(drive.base_bias_uT.array(), " uT"));
    text += changes_text(drive);
  }
  text += fmt::format(
      "{} old fingerprints {} replaced, {} new ones added; {} new ones only confirm what is known\n",
      update.replaced_now, made ? "are" : "would be", update.added, update.confirming);
  if (made) text += coverage_text(*made) + drives_text(*made);
  return text;
}

std::string update_report_json(const LocatedDrives& drives, const FieldUpdate& update,
                               const std::optional<FieldMap>& made, std::size_t first) {
  nlohmann::ordered_json json{{"drives", nlohmann::ordered_json::array()}};
  for (const DriveComparison& compared : update.drives) {
    nlohmann::ordered_json drive{{"log", name_of(drives, compared, first)}};
    if (!drives.found.empty())
      drive["found_after_m"] = drives.found[static_cast<std::size_t>(compared.session) - first].travelled_m;
    drive["refused"] = compared.refused;
    drive.update(to_json(compared));
    json["drives"].push_back(std::move(drive));
  }
  json["fingerprints_replaced"] = update.replaced_now;
  json["fingerprints_added"] = update.added;
  json["fingerprints_confirming"] = update.confirming;
  json["fingerprints"] = update.fingerprints.size();
  if (made) json["coverage"] = coverage_json(*made);
  if (made) json["survey"] = drives_json(*made);
  return json.dump() + "\n";
}

}  // namespace mstsl::app
