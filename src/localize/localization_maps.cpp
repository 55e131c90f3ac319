#include "mstsl/localize/localization_maps.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "mstsl/localize/building_axis.hpp"

namespace mstsl {
namespace {

bool is_free(const OccupancyGrid& occupancy, const Eigen::Vector2d& map_point_m) {
  return state_at(occupancy, map_point_m) == CellState::kFree;
}

/// Takes support from places that are not free; the share that was free.
double keep_free_cells(const OccupancyGrid& occupancy, FieldMap& field) {
  std::size_t before = 0, kept = 0;
  for (std::size_t i = 0; i < field.supported.size(); ++i) {
    if (field.supported[i] == 0 || !field.has_value(field.geometry.cell(i))) continue;
    ++before;
    if (is_free(occupancy, field.geometry.center_of(field.geometry.cell(i))))
      ++kept;
    else
      field.supported[i] = 0;
  }
  return before == 0 ? 0.0 : static_cast<double>(kept) / static_cast<double>(before);
}

double keep_free_fingerprints(const OccupancyGrid& occupancy, FieldMap& field) {
  const std::size_t before = field.fingerprints.size();
  std::erase_if(field.fingerprints,
                [&](const Fingerprint& print) { return !is_free(occupancy, print.position_m); });
  return before == 0 ? 0.0 : static_cast<double>(field.fingerprints.size()) / static_cast<double>(before);
}

}  // namespace

Result<std::shared_ptr<const LocalizationMaps>> make_localization_maps(
    OccupancyGrid occupancy, FieldMap field, const LocalizationMapsOptions& options) {
  if (count(occupancy, CellState::kFree) == 0)
    return Error("the occupancy map has no free cell; check its thresholds and 'negate'");
  const std::optional<double> axis = building_axis(occupancy);
  if (!axis)
    return Error("the occupancy map has no wall next to free space, so no scan can be matched to it");
  const double on_free = field.model == FieldModel::kFingerprint ? keep_free_fingerprints(occupancy, field)
                                                                 : keep_free_cells(occupancy, field);
  if (!(on_free > 0.0) || on_free < options.min_field_on_free_share)
    return Error(fmt::format(
        "the field map is of another place: only {:.0f} % of it lies on free cells of the occupancy map; "
        "give it the field map made with this very map",
        100.0 * on_free));
  FieldSampler field_cells(field);
  Lazy<MatchMap> walls([occupancy] { return MatchMap(occupancy); });
  Lazy<FieldMatcher> matcher(
      [field = std::make_shared<const FieldMap>(std::move(field)), threads = options.threads] {
        return FieldMatcher::make(*field, {.threads = threads}).value();  // it has a value on a free cell
      });
  return std::make_shared<const LocalizationMaps>(LocalizationMaps{
      std::move(occupancy), std::move(field_cells), *axis, on_free, std::move(walls), std::move(matcher)});
}

}  // namespace mstsl
