#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

#include "encode.hpp"
#include "run_json.hpp"

namespace mstsl::report {
namespace {

using Json = nlohmann::ordered_json;

Json geometry_json(const GridGeometry& g) {
  return {{"resolution_m", g.resolution_m},
          {"columns", g.columns},
          {"rows", g.rows},
          {"x", g.map_T_grid.x},
          {"y", g.map_T_grid.y},
          {"yaw", g.map_T_grid.yaw}};
}

/// The cells that hold all that is known, a few around them.
struct Crop {
  int column0 = 0, row0 = 0, columns = 0, rows = 0;
};

Crop known_part(const OccupancyGrid& grid) {
  const GridGeometry& g = grid.geometry();
  int low_column = g.columns, low_row = g.rows, high_column = -1, high_row = -1;
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (grid.values()[i] == CellState::kUnknown) continue;
    const Cell cell = g.cell(i);
    low_column = std::min(low_column, cell.column), high_column = std::max(high_column, cell.column);
    low_row = std::min(low_row, cell.row), high_row = std::max(high_row, cell.row);
  }
  if (high_column < 0) return {0, 0, g.columns, g.rows};
  constexpr int kAround = 10;
  low_column = std::max(0, low_column - kAround), low_row = std::max(0, low_row - kAround);
  return {low_column, low_row, std::min(g.columns, high_column + kAround + 1) - low_column,
          std::min(g.rows, high_row + kAround + 1) - low_row};
}

Json map_json(const OccupancyGrid& grid) {
  const Crop crop = known_part(grid);
  GridGeometry g = grid.geometry();
  const Eigen::Vector2d corner_m = g.to_map(Eigen::Vector2d(crop.column0, crop.row0));
  g.map_T_grid = Pose2::from(corner_m, g.map_T_grid.yaw);
  g.columns = crop.columns, g.rows = crop.rows;

  constexpr std::array kOrder{CellState::kUnknown, CellState::kFree, CellState::kOccupied};
  std::vector<int> runs{0};
  for (int row = 0; row < crop.rows; ++row)
    for (int column = 0; column < crop.columns; ++column) {
      const CellState state = grid[{crop.column0 + column, crop.row0 + row}];
      while (kOrder[(runs.size() - 1) % kOrder.size()] != state) runs.push_back(0);
      ++runs.back();
    }
  Json json = geometry_json(g);
  json["runs"] = runs;
  return json;
}

/// |B| in the middle of squares of `side` cells, where the map has a value and the occupancy map is free.
std::vector<float> strengths(const TracedPlace& place, int side, const GridGeometry& coarse) {
  std::vector<float> values;
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    const Cell cell = coarse.cell(i);
    const Cell middle{std::min(cell.column * side + side / 2, place.field.geometry.columns - 1),
                      std::min(cell.row * side + side / 2, place.field.geometry.rows - 1)};
    const std::size_t at = place.field.geometry.index(middle);
    const bool shown = place.field.supported[at] != 0 && place.field.mean_uT[at].allFinite() &&
                       state_at(place.occupancy, coarse.center_of(cell)) == CellState::kFree;
    values.push_back(shown ? place.field.mean_uT[at].norm() : -1.0F);
  }
  return values;
}

Json field_json(const TracedPlace& place) {
  constexpr double kCell_m = 0.1;
  GridGeometry coarse = place.field.geometry;
  const int side = std::max(1, static_cast<int>(std::lround(kCell_m / coarse.resolution_m)));
  coarse.resolution_m *= side;
  coarse.columns = (coarse.columns + side - 1) / side;
  coarse.rows = (coarse.rows + side - 1) / side;
  const std::vector<float> values = strengths(place, side, coarse);
  std::vector<float> shown;
  std::ranges::copy_if(values, std::back_inserter(shown), [](float v) { return v >= 0; });
  if (shown.empty()) return nullptr;
  // The 1st to 99th percentile: a single magnet does not bleach all else.
  std::ranges::sort(shown);
  const float low = shown[shown.size() / 100], high = std::max(low + 1.0F, shown[shown.size() * 99 / 100]);
  std::string bytes;
  for (const float v : values)
    bytes += static_cast<char>(
        v < 0 ? 255
              : static_cast<int>(std::lround(254.0F * std::clamp((v - low) / (high - low), 0.0F, 1.0F))));
  Json json = geometry_json(coarse);
  json["low_uT"] = low;
  json["high_uT"] = high;
  json["values"] = base64(bytes);
  return json;
}

}  // namespace

std::string place_json(const TracedPlace& place) {
  return Json{{"name", place.name}, {"map", map_json(place.occupancy)}, {"field", field_json(place)}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace mstsl::report
