#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/result.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::datasets {

using Path = std::vector<Eigen::Vector2d>;

/// Corridors around paths whose walls nobody recorded.
struct TubeOptions {
  double width_m = 2.2;        ///< an office corridor's usual width
  double resolution_m = 0.05;  ///< of the raster in which the tubes are joined
};

/// The union of tubes around all paths: cells within half the width of one are free, all others occupied.
/// Errors: no point at all, points that are not finite or spread over more than a building.
Result<OccupancyGrid> tubes_around(std::span<const Path> paths_m, const TubeOptions& options = {});

/// The direction that most of the paths' length shares, modulo 90 deg, in (-45, 45] deg: the building's axis.
double shared_axis_rad(std::span<const Path> paths_m);

/// A building whose walls are the outlines of the tubes and whose lanes are the first path. It has no steel:
/// its field is whatever was measured.
Result<sim::WorldPlan> tube_plan(std::span<const Path> paths_m, const TubeOptions& options = {});

}  // namespace mstsl::datasets
