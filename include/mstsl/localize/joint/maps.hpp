#pragma once

#include <memory>

#include "mstsl/localize/joint/field_search.hpp"
#include "mstsl/localize/localization_maps.hpp"
#include "mstsl/scan/place_search.hpp"
#include "mstsl/scan/wall_field.hpp"

namespace mstsl::joint {

/// What the joint method reads. Made once, then only read, by as many runs and threads as like.
struct Maps {
  std::shared_ptr<const LocalizationMaps> both;
  std::shared_ptr<const WallField> walls;
  PlaceSearch places;
  FieldSearch by_field;
};

std::shared_ptr<const Maps> make_maps(std::shared_ptr<const LocalizationMaps> both,
                                      const PlaceSearchOptions& options = {});

}  // namespace mstsl::joint
