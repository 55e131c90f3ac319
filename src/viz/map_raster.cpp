#include "map_raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "theme.hpp"

namespace mstsl::viz {
namespace {

constexpr double kUnsupportedAlpha = 0.3;

Raster blank(int width, int height) {
  Raster raster{width, height, {}};
  raster.pixels.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  return raster;
}

bool is_floor(const FieldMap& field, std::size_t cell, const OccupancyGrid& map) {
  return state_at(map, field.geometry.center_of(field.geometry.cell(cell))) == CellState::kFree;
}

}  // namespace

double field_value(const FieldMap& field, std::size_t cell, FieldQuantity quantity) {
  const Eigen::Vector3f& mean = field.mean_uT[cell];
  switch (quantity) {
    case FieldQuantity::kNorm:
      return mean.norm();
    case FieldQuantity::kX:
      return mean.x();
    case FieldQuantity::kY:
      return mean.y();
    case FieldQuantity::kZ:
      return mean.z();
    case FieldQuantity::kDeviation:
      return std::sqrt(field.variance_uT2[cell].mean());
  }
  return std::numeric_limits<double>::quiet_NaN();
}

ValueRange shown_range(const FieldMap& field, const OccupancyGrid& map, FieldQuantity quantity) {
  std::vector<double> values;
  for (std::size_t i = 0; i < field.mean_uT.size(); ++i) {
    const double value = field_value(field, i, quantity);
    if (std::isfinite(value) && field.supported[i] != 0 && is_floor(field, i, map)) values.push_back(value);
  }
  if (values.empty()) return {};
  const auto percentile = [&](double share) {
    const auto nth =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
  };
  const ValueRange range{percentile(0.01), percentile(0.99)};
  return range.high > range.low ? range : ValueRange{range.low - 0.5, range.low + 0.5};
}

Raster floor_raster(const OccupancyGrid& map) {
  Raster raster = blank(map.geometry().columns, map.geometry().rows);
  // Occupied cells count as floor too: walls are drawn over it, and no seam shows at their edges.
  for (std::size_t i = 0; i < raster.pixels.size(); ++i)
    if (map.values()[i] != CellState::kUnknown) raster.pixels[i] = to_pixel(theme::kFloor);
  return raster;
}

Raster wall_raster(const OccupancyGrid& map, int cells) {
  const GridGeometry& g = map.geometry();
  Raster raster = blank((g.columns + cells - 1) / cells, (g.rows + cells - 1) / cells);
  for (std::size_t i = 0; i < map.values().size(); ++i) {
    if (map.values()[i] != CellState::kOccupied) continue;
    const Cell cell = g.cell(i);
    raster.pixels[static_cast<std::size_t>(cell.row / cells) * static_cast<std::size_t>(raster.width) +
                  static_cast<std::size_t>(cell.column / cells)] = to_pixel(theme::kWall);
  }
  return raster;
}

Raster field_raster(const FieldMap& field, const OccupancyGrid& map, FieldQuantity quantity,
                    const ValueRange& range) {
  Raster raster = blank(field.geometry.columns, field.geometry.rows);
  for (std::size_t i = 0; i < raster.pixels.size(); ++i) {
    const double value = field_value(field, i, quantity);
    if (!std::isfinite(value) || !is_floor(field, i, map)) continue;
    raster.pixels[i] =
        to_pixel(viridis(range.share(value)).with_alpha(field.supported[i] != 0 ? 1.0 : kUnsupportedAlpha));
  }
  return raster;
}

}  // namespace mstsl::viz
