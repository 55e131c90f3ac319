#include "mstsl/localize/joint/maps.hpp"

#include <utility>

namespace mstsl::joint {

std::shared_ptr<const Maps> make_maps(std::shared_ptr<const LocalizationMaps> both,
                                      const PlaceSearchOptions& options) {
  auto walls = std::make_shared<const WallField>(both->occupancy);
  PlaceSearch places(both->occupancy, walls, options);
  FieldSearch by_field(both->occupancy);
  return std::make_shared<const Maps>(
      Maps{std::move(both), std::move(walls), std::move(places), std::move(by_field)});
}

}  // namespace mstsl::joint
