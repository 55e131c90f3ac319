#pragma once

#include <optional>

#include "mstsl/core/result.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/mapping/occupancy_mapper.hpp"

namespace mstsl {

struct TrackDrawerOptions {
  MappingOptions map;
  /// A scan is drawn after so much motion (m, rad) or time (s) since the last one drawn: cells as small as
  /// the map's are then seen often enough, and a robot that stands shows no more by standing longer.
  double every_m = 0.10;
  double every_rad = 0.10;
  double every_s = 2.0;
};

/// Draws the scans of drives whose ways are known into one map, each from where the robot was when it was
/// taken.
class TrackDrawer {
 public:
  explicit TrackDrawer(const TrackDrawerOptions& options = {}) : options_(options), mapper_(options.map) {}

  /// What follows are the scans of this drive. The trajectory must outlive them.
  void begin_drive(const Rig& rig, const Trajectory& map_T_base);
  void observe(const LaserScan& scan);

  /// The map so far. Errors: as OccupancyMapper::insert.
  Result<OccupancyGrid> grid() const;

 private:
  TrackDrawerOptions options_;
  OccupancyMapper mapper_;
  Rig rig_;
  const Trajectory* map_T_base_ = nullptr;
  std::optional<TimedPose> last_;
  std::optional<Error> error_;
};

}  // namespace mstsl
