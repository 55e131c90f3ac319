#pragma once

#include <Eigen/Core>

#include "mstsl/grid/distance_field.hpp"
#include "mstsl/grid/frame.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/scan/wall_sample.hpp"

namespace mstsl {

struct WallFieldOptions {
  /// Farther from every wall than this (m) distances are not kept: what the bounds of a search over blocks of
  /// poses need (PlaceSearch), far beyond what pulls a point.
  double reach_m = 1.0;
  /// The directions of walls are averaged over this radius (m): two cells to each side of a 5 cm grid, so
  /// that the stairs of an oblique wall are one wall.
  double smoothing_m = 0.10;
};

/// The walls of a map as a scan matcher wants them: the squared distance to the nearest occupied cell with
/// its slope, and which way the wall there faces. Made once, then only read.
class WallField {
 public:
  explicit WallField(const OccupancyGrid& occupancy, const WallFieldOptions& options = {});

  const GridGeometry& geometry() const { return distances_.geometry(); }
  const GridFrame& frame() const { return frame_; }
  const DistanceField& distances() const { return distances_; }
  double reach_m() const { return distances_.max_distance_m(); }

  using Sample = WallSample;
  /// At a map point; far from every wall (and outside the grid) the distance is the reach and all else zero.
  Sample sample(const Eigen::Vector2d& map_point_m) const;

 private:
  DistanceField distances_;
  GridFrame frame_;
  Grid<Eigen::Vector3f> facing_;
};

}  // namespace mstsl
