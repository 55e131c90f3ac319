#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mstsl/scan/points.hpp"
#include "mstsl/scan/wall_field.hpp"

namespace mstsl {

/// Upper bounds on WallFit::score over blocks of poses. Distances to walls change no faster than a point
/// moves (they are 1-Lipschitz), so poses that move a point by at most `slack` let it score at most
/// exp(-max(0, d - slack)^2 / (2 sigma^2)), d being its distance at the block's middle. Layers of that bound
/// for some slacks are kept, one byte a cell.
class ScoreBounds {
 public:
  /// `reach_m`: points are no farther from the base than this; `sigma_m` as in FitOptions.
  ScoreBounds(const WallField& walls, double sigma_m, double reach_m);

  /// A scan turned to one heading.
  class Probe {
   public:
    /// The bound (or score) at a place on the grid, 0 .. 1; some value below `least` as soon as it is known
    /// to be below.
    double at(std::size_t place, double least) const;

   private:
    friend class ScoreBounds;
    std::vector<const std::uint8_t*> points_;  ///< each point's layer, shifted by where the point lies
  };
  /// Bounds for blocks of a side and a width of headings. Expects points within the reach.
  Probe bound(const PointSet& points_base_m, double heading_rad, double side_m, double headings_rad) const;
  /// The score itself, but for the rounding to cells.
  Probe score(const PointSet& points_base_m, double heading_rad) const;

  /// What Probe::at() takes for a point of the map, which must lie on the grid.
  std::size_t place(const Eigen::Vector2d& map_point_m) const;

 private:
  struct Layer {
    double slack_m;
    std::vector<std::uint8_t> values;
  };
  template <typename Slack>
  Probe probe(const PointSet& points_base_m, double heading_rad, Slack slack) const;

  GridFrame frame_;
  int margin_;  ///< cells around the grid, so that no point of a robot on it lies outside
  std::size_t stride_;
  std::vector<Layer> layers_;
};

}  // namespace mstsl
