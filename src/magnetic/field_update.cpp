#include "mstsl/magnetic/field_update.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "drive_comparison.hpp"
#include "field_area.hpp"
#include "point_bins.hpp"

namespace mstsl {
namespace {

using Eigen::Vector2d;

/// The new drives as one, to find what lies near a place.
struct NewDrives {
  std::vector<Fingerprint> fingerprints;
  std::vector<std::uint8_t> changed;
  std::vector<Vector2d> positions_m;

  void add(ComparedDrive drive) {
    for (const Fingerprint& f : drive.fingerprints) positions_m.push_back(f.position_m);
    fingerprints.insert(fingerprints.end(), drive.fingerprints.begin(), drive.fingerprints.end());
    changed.insert(changed.end(), drive.changed.begin(), drive.changed.end());
  }
};

/// The session of the new drive that contradicts an old fingerprint, or -1: its nearest new neighbour within
/// `reach_m` decides.
int replaced_by(const Fingerprint& old, const NewDrives& drives, const PointBins& bins, double reach_m) {
  double nearest_m = reach_m;
  int by = -1;
  const Vector2d reach = Vector2d::Constant(reach_m);
  bins.for_each_near(old.position_m - reach, old.position_m + reach, [&](std::size_t i) {
    const double away_m = (drives.positions_m[i] - old.position_m).norm();
    if (away_m >= nearest_m) return;
    nearest_m = away_m;
    by = drives.changed[i] != 0 ? drives.fingerprints[i].session : -1;
  });
  return by;
}

/// How far aside of a drive a change is taken to reach: as far as the field is alike.
double reach_of(const FieldMap& map) {
  constexpr double kUnknown_m = 0.5;  // the shortest length scales of real buildings
  double reach_m = std::numeric_limits<double>::infinity();
  for (const char* name : {"length_scale_x_m", "length_scale_y_m", "length_scale_z_m"})
    if (const auto length = map.hyperparameters.find(name); length != map.hyperparameters.end())
      reach_m = std::min(reach_m, length->second);
  return std::isfinite(reach_m) && reach_m > 0.0 ? reach_m : kUnknown_m;
}

/// Those of a drive that lie nowhere near what is kept already.
std::vector<Fingerprint> not_near(std::span<const Fingerprint> drive, const std::vector<Fingerprint>& kept,
                                  double near_m) {
  std::vector<Vector2d> positions_m;
  for (const Fingerprint& f : kept) positions_m.push_back(f.position_m);
  const PointBins bins(positions_m, near_m);
  const Vector2d reach = Vector2d::Constant(near_m);
  std::vector<Fingerprint> found;
  for (const Fingerprint& f : drive) {
    bool near = false;
    bins.for_each_near(f.position_m - reach, f.position_m + reach, [&](std::size_t i) {
      near = near || (positions_m[i] - f.position_m).norm() < near_m;
    });
    if (!near) found.push_back(f);
  }
  return found;
}

std::vector<std::span<const Fingerprint>> by_session(std::span<const Fingerprint> drives) {
  std::vector<std::span<const Fingerprint>> sessions;
  for (std::size_t i = 0; i < drives.size();) {
    std::size_t end = i;
    while (end < drives.size() && drives[end].session == drives[i].session) ++end;
    sessions.push_back(drives.subspan(i, end - i));
    i = end;
  }
  return sessions;
}

/// Why a drive cannot be used; empty where it can.
std::string refusal(const DriveComparison& drive, const FieldUpdateOptions& options) {
  if (drive.compared_m <=
      0.0)  // a guess of the map's, where nothing was surveyed, is none to be held against
    return "it does not come near anything that the map was made from; nothing can be compared";
  if (drive.unexplained <= options.unexplained_share) return {};
  return fmt::format(
      "it contradicts the map nearly everywhere (its errors are typically {:.0f} % of the field's own "
      "changes along it): was it found at the right place, is it another building, another mounting of the "
      "magnetometer, a calibration forgotten? If all has changed, make the map anew",
      100 * std::sqrt(drive.unexplained));
}

}  // namespace

Result<FieldUpdate> update_survey(const FieldMap& map, std::span<const Fingerprint> drives,
                                  const FieldUpdateOptions& options) {
  if (map.fingerprints.empty())
    return Error("the map does not hold the fingerprints that it was made from, so it cannot be updated");
  if (drives.empty()) return Error("the new drives hold no fingerprint; is the field's topic the right one?");
  FieldUpdate update;
  update.replaced = map.replaced;
  NewDrives added;
  for (const std::span<const Fingerprint> session : by_session(drives)) {
    ComparedDrive drive = compare_drive(map, session, options);
    drive.comparison.session = session.front().session;
    drive.comparison.refused = refusal(drive.comparison, options);
    update.drives.push_back(drive.comparison);
    if (drive.comparison.refused.empty()) added.add(std::move(drive));
  }
  if (added.fingerprints.empty())
    return Error(fmt::format("the {}drive cannot be used: {}", update.drives.size() > 1 ? "first " : "",
                             update.drives.front().refused));
  const double reach_m = reach_of(map);
  const PointBins bins(added.positions_m, reach_m);
  for (const Fingerprint& old : map.fingerprints) {
    const int by = replaced_by(old, added, bins, reach_m);
    if (by < 0)
      update.fingerprints.push_back(old);
    else
      update.replaced.push_back({old, by});
  }
  update.replaced_now = update.replaced.size() - map.replaced.size();
  constexpr double kNear = 0.25;  // of a length scale: there the correlation is exp(-1 / 32)
  for (const std::span<const Fingerprint> session : by_session(added.fingerprints)) {
    const std::vector<Fingerprint> found = not_near(session, update.fingerprints, kNear * reach_m);
    update.added += found.size();
    update.confirming += session.size() - found.size();
    update.fingerprints.insert(update.fingerprints.end(), found.begin(), found.end());
  }
  return update;
}

std::vector<std::int32_t> newest_drives(const FieldMap& made, const FieldMap& before,
                                        std::span<const Fingerprint> drives) {
  std::vector<std::int32_t> newest = made.newest_drive;
  newest.resize(made.geometry.size(), -1);
  const double reach_m = reach_of(made);
  for (const std::span<const Fingerprint> session : by_session(drives)) {
    const std::vector<float> distance_m =
        distances_to(session, made.geometry, reach_m + made.geometry.resolution_m);
    for (std::size_t i = 0; i < newest.size(); ++i)
      if (made.supported[i] != 0 && distance_m[i] <= reach_m)
        newest[i] = std::max(newest[i], session.front().session);
  }
  for (std::size_t i = 0; i < newest.size() && !before.newest_drive.empty(); ++i) {
    const Cell was = before.geometry.cell_at(made.geometry.center_of(made.geometry.cell(i)));
    if (made.supported[i] != 0 && before.geometry.contains(was))
      newest[i] = std::max(newest[i], before.newest_drive[before.geometry.index(was)]);
  }
  return newest;
}

SurveyAnalysisOptions analysis_as_before(const FieldMap& map) {
  SurveyAnalysisOptions options;
  options.bias_removal = BiasRemoval::kNever;
  const auto number = [&](const char* name) {
    const auto found = map.hyperparameters.find(name);
    return found == map.hyperparameters.end() ? std::nullopt : std::optional(found->second);
  };
  if (const auto spacing_m = number("lattice_spacing_m"); spacing_m && *spacing_m > 0.0)
    options.bilinear_spacing_m = spacing_m;
  const auto known = from_named(map.hyperparameters);
  if (!known) return options;
  const auto depth_m = number("harmonic_depth_m"), side = number("harmonic_side");
  const bool harmonic =
      depth_m && side && *depth_m > 0.0 && *side >= 0.0 && *side <= static_cast<double>(SourceSide::kBoth);
  if (harmonic)
    options.harmonic = HarmonicHyperparameters{static_cast<SourceSide>(static_cast<int>(*side)), *depth_m,
                                               known->signal_sd_uT.z(), known->mean_uT, known->noise_sd_uT};
  else if (!depth_m)
    options.hyperparameters = known;
  return options;
}

}  // namespace mstsl
