#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "mstsl/core/parallel.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/localize/localization_maps.hpp"
#include "mstsl/sim/drive.hpp"
#include "mstsl/sim/world.hpp"

#include "hard_disturbance.hpp"

namespace mstsl {

/// How a building was surveyed: one field map each.
struct SurveyKind {
  bool weak_field = false, sparse = false;
  friend bool operator==(const SurveyKind&, const SurveyKind&) = default;
  std::string name() const;
};
inline SurveyKind survey_kind(const Disturbance& d) { return {d.weak_field, d.sparse}; }

/// A building as it was on the day of the survey, with the maps that were then made.
struct HardBuilding {
  sim::World surveyed;
  double steel_share = 1.0;  ///< of the steel's field that is there: below 1 in a weak field
  std::shared_ptr<const LocalizationMaps> maps;
};

/// The field that steel of a lesser share makes in a world (which must outlive it).
sim::FieldSource weakened(const sim::World& world, double steel_share);

/// The field's SD along the lanes, at a magnetometer's height: root mean square over the axes, uT.
double field_spread_uT(const sim::World& world);

/// Builds and surveys, or reads the field map that `folder` keeps. `name` is that of the map's file.
Result<HardBuilding> make_building(const std::string& world, const SurveyKind& kind, const Random& random,
                                   const std::filesystem::path& folder, const std::string& name,
                                   Threads threads);

}  // namespace mstsl
