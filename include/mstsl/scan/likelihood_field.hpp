#pragma once

#include <Eigen/Core>

#include "mstsl/grid/frame.hpp"
#include "mstsl/grid/occupancy_grid.hpp"

namespace mstsl {

struct LikelihoodOptions {
  /// Standard deviation of a scan point's distance from its wall in the map (m): range noise (1 cm), the
  /// map's cells and its errors. In four real buildings (Freiburg, Seattle, ACES, Intel; half the scans
  /// drawn, the others matched) 7.5 cm makes the covariance of refine_pose() true or a little cautious; 5 cm
  /// makes it claim too much. Never less than 1.5 cells is used: a narrower field has no useful slope.
  double sigma_m = 0.075;
};

/// How well a scan point at each place agrees with the map: exp(-d^2 / (2 sigma^2)), d being the distance to
/// the nearest occupied cell; 1 on a wall, 0 beyond three sigma and outside the map. (Thrun, Burgard & Fox,
/// Probabilistic Robotics, Sec. 6.4, without its normalisation; it stands for M_smooth in Hess et al. 2016.)
class LikelihoodField {
 public:
  explicit LikelihoodField(const OccupancyGrid& occupancy, const LikelihoodOptions& options = {});

  const GridGeometry& geometry() const { return values_.geometry(); }
  const GridFrame& frame() const { return frame_; }
  const Grid<float>& values() const { return values_; }
  double sigma_m() const { return sigma_m_; }

  struct Sample {
    double value = 0.0;
    Eigen::Vector2d gradient_per_cell = Eigen::Vector2d::Zero();  ///< along the grid's axes
  };
  /// Bicubic interpolation (Catmull-Rom) at a point in cells from the grid's origin, with its exact gradient;
  /// zero outside the grid. Continuous with its first derivative. Expects a finite point.
  Sample sample(const Eigen::Vector2d& grid_point_cells) const;

 private:
  Grid<float> values_;
  GridFrame frame_;
  double sigma_m_;
};

}  // namespace mstsl
