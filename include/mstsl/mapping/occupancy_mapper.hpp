#pragma once

#include <cstddef>

#include <Eigen/Geometry>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/grid/grid.hpp"
#include "mstsl/grid/occupancy_grid.hpp"

namespace mstsl {

struct MappingOptions {
  double resolution_m = 0.05;
  /// Evidence of one beam that ends in, or passes through, a cell, in log odds: probabilities 0.7 and 0.4
  /// (Thrun, Burgard & Fox, Sec. 9.2, and the defaults of GMapping's and Hector's kin). A wall must be seen
  /// through twice as often as hit to vanish.
  double hit_log_odds = 0.85;
  double miss_log_odds = -0.4;
  /// Belief stops here, so that a map can still change its mind.
  double limit_log_odds = 6.0;
  /// Trinary reading: occupied above, free below these probabilities (map_server's defaults).
  double occupied_probability = 0.65;
  double free_probability = 0.196;
  /// Returns beyond are only used to clear the way up to here (m).
  double max_range_m = 30.0;
  /// More cells than this is an error (a pose gone astray), not a machine out of memory: 1 km x 1 km of 5 cm
  /// cells.
  std::size_t max_cells = 400'000'000;
};

/// An occupancy grid from scans with known poses: each beam lowers the log odds of the cells that it passes
/// and raises that of the cell where it ends. The grid grows as the robot goes.
class OccupancyMapper {
 public:
  explicit OccupancyMapper(const MappingOptions& options = {});

  /// Draws a scan taken at `map_T_base` (the base at the scan's stamp); `first_T_last` de-skews, as in
  /// points.hpp. An error, and nothing drawn, when the pose is not finite or the map would grow beyond
  /// max_cells.
  Result<void> insert(const LaserScan& scan, const Eigen::Isometry3d& base_T_laser, const Pose2& map_T_base,
                      const Pose2& first_T_last = {});

  /// The map so far, cut to the cells ever touched; without any scan, a grid without cells.
  OccupancyGrid grid() const;

 private:
  MappingOptions options_;
  Grid<float> log_odds_;
};

}  // namespace mstsl
