#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

#include "report/run_json.hpp"

namespace mstsl::report {
namespace {

TracedPlace random_place(Random& random) {
  const GridGeometry g{
      .resolution_m = 0.05,
      .columns = 80,
      .rows = 60,
      .map_T_grid = {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-kPi, kPi)}};
  TracedPlace place{"somewhere", OccupancyGrid(g, CellState::kUnknown), {}};
  for (int row = 15; row < 40; ++row)
    for (int column = 20; column < 70; ++column)
      place.occupancy[{column, row}] = random.uniform() < 0.1 ? CellState::kOccupied : CellState::kFree;
  place.field.geometry = g;
  place.field.mean_uT.assign(g.size(), Eigen::Vector3f(30, 0, 40));
  place.field.variance_uT2.assign(g.size(), Eigen::Vector3f::Ones());
  place.field.supported.assign(g.size(), 1);
  return place;
}

TEST(PlaceJson, HoldsTheGridCroppedToWhatIsKnown) {
  Random random(4);
  const TracedPlace place = random_place(random);
  const auto map = nlohmann::json::parse(place_json(place)).at("map");
  const GridGeometry g{.resolution_m = map.at("resolution_m"),
                       .columns = map.at("columns"),
                       .rows = map.at("rows"),
                       .map_T_grid = {map.at("x"), map.at("y"), map.at("yaw")}};
  EXPECT_LT(g.size(), place.occupancy.geometry().size());
  constexpr std::array kOrder{CellState::kUnknown, CellState::kFree, CellState::kOccupied};
  std::vector<CellState> cells;
  for (std::size_t i = 0; i < map.at("runs").size(); ++i)
    cells.insert(cells.end(), map.at("runs")[i].get<std::size_t>(), kOrder[i % 3]);
  ASSERT_EQ(cells.size(), g.size());
  std::size_t known = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_EQ(cells[i], state_at(place.occupancy, g.center_of(g.cell(i)))) << "cell " << i;
    known += cells[i] != CellState::kUnknown;
  }
  EXPECT_EQ(known, 25u * 50u) << "nothing known is cut away";
}

TEST(PlaceJson, IsNoFieldWhereNoneIsKnown) {
  Random random(5);
  TracedPlace place = random_place(random);
  EXPECT_FALSE(nlohmann::json::parse(place_json(place)).at("field").is_null());
  place.field.supported.assign(place.field.supported.size(), 0);
  EXPECT_TRUE(nlohmann::json::parse(place_json(place)).at("field").is_null());
}

}  // namespace
}  // namespace mstsl::report
