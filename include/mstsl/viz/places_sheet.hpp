#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/viz/canvas.hpp"

namespace mstsl::viz {

/// What is said of one place of a map.
struct PlaceMark {
  Eigen::Vector2d place_m;
  double share = 0.0;    ///< 0 (dark) to 1 (bright)
  bool warning = false;  ///< ringed
};

/// Shares of something, place by place, as discs on the map, with a bar that says what the colours mean.
Canvas draw_places(const OccupancyGrid& map, const std::vector<PlaceMark>& places, double spacing_m,
                   const std::string& title, const std::string& subtitle, const std::string& label,
                   double width_px = 1600.0);

}  // namespace mstsl::viz
