#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/parallel.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/localize/joint/mode.hpp"
#include "mstsl/localize/joint/step.hpp"

namespace mstsl::joint {

struct FieldSearchOptions {
  double step_m = 0.25;  ///< between places, a fraction of the 0.4 m over which the fastest fields change
  double turn_rad = radians(10.0);  ///< between headings: 20 uT of horizontal field turn by 3.5 uT
  double stations_every_m = 0.3;    ///< nearer ones tell next to nothing more
  std::size_t max_stations = 12;
  /// Poses whose log density is this much below the best are left out; there are never more than so many.
  double below_best = 12.0;
  std::size_t max_poses = 2000;
};

/// Lists the poses, over the whole free space and all headings, at which the last metres of the way explain
/// what the magnetometer read, its bias unknown: for when the lidar sees nothing. A grid over places and
/// headings, each weighed in closed form (the bias is Gaussian and integrated out).
class FieldSearch {
 public:
  FieldSearch(const OccupancyGrid& occupancy, const FieldSearchOptions& options = {});

  const FieldSearchOptions& options() const { return options_; }

  /// Where the base may be now. `way` holds stations as seen from there, in the order of the drive.
  std::vector<Pose2> find(std::span<const Station> way, const FieldSampler& field,
                          const Eigen::Vector2d& magnetometer_m, const FieldModel& model,
                          Threads threads) const;

 private:
  FieldSearchOptions options_;
  std::vector<Eigen::Vector2d> places_m_;
};

}  // namespace mstsl::joint
