#pragma once

#include <cstddef>

#include <Eigen/Geometry>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/scan/log_odds_grid.hpp"

namespace mstsl {

struct MappingOptions {
  double resolution_m = 0.05;  ///< the paper's cell size
  BeamModel beams = {};
  /// The trinary reading: occupied above, free below these probabilities (map_server's defaults).
  double occupied_probability = 0.65;
  double free_probability = 0.196;
  /// More cells than this are an error (a pose gone astray) and not a machine out of memory: 1 km by 1 km of
  /// 5 cm cells.
  std::size_t max_cells = 400'000'000;
};

/// An occupancy grid from scans with known poses (Moravec & Elfes 1985; Thrun, Burgard & Fox, Table 9.1):
/// each scan lowers the log odds of the cells that its beams pass and raises those of the cells where they
/// end. The grid lies along the map frame's axes and grows as the robot goes.
class OccupancyMapper {
 public:
  explicit OccupancyMapper(const MappingOptions& options = {});

  /// Draws a scan taken at `map_T_base` (the base at the scan's stamp); `first_T_last` de-skews it, as in
  /// beam_returns(). An error, and nothing drawn, when the pose is not finite or the map would grow beyond
  /// max_cells.
  Result<void> insert(const LaserScan& scan, const Eigen::Isometry3d& base_T_laser, const Pose2& map_T_base,
                      const Pose2& first_T_last = {});

  /// The map so far, cut to the cells that a beam touched; without any, a grid without cells.
  OccupancyGrid grid() const;

 private:
  MappingOptions options_;
  LogOddsGrid drawn_;
};

}  // namespace mstsl
