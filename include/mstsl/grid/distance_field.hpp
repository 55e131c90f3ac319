#pragma once

#include <Eigen/Core>

#include "mstsl/grid/frame.hpp"
#include "mstsl/grid/occupancy_grid.hpp"

namespace mstsl {

/// How far each place of a map is from the nearest wall: for each cell the exact Euclidean distance (m) from
/// its centre to the centre of the nearest occupied cell, at most `max_distance_m`. Felzenszwalb &
/// Huttenlocher, "Distance transforms of sampled functions", Theory of Computing 8 (2012): two passes of
/// lower envelopes of parabolas, linear in the number of cells.
class DistanceField {
 public:
  /// Expects max_distance_m > 0; where no occupied cell is nearer (or there is none at all) the distance is
  /// that.
  DistanceField(const OccupancyGrid& occupancy, double max_distance_m);

  const GridGeometry& geometry() const { return distances_m_.geometry(); }
  const Grid<float>& values_m() const { return distances_m_; }
  double max_distance_m() const { return max_distance_m_; }

  /// The distance at the centre of a cell; the maximum outside the grid.
  double at(Cell cell) const { return distances_m_.contains(cell) ? distances_m_[cell] : max_distance_m_; }

  /// The distance at a map point, bilinear between the four nearest cell centres; the maximum outside the
  /// grid.
  double at(const Eigen::Vector2d& map_point_m) const;

 private:
  Grid<float> distances_m_;
  GridFrame frame_;
  double max_distance_m_;
};

}  // namespace mstsl
