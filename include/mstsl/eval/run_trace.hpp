#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "mstsl/core/sensor_data.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/localize/estimate.hpp"
#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl {

/// Whether everything that is to be seen of a run is kept. A long run's hypotheses would fill the memory.
enum class Traced { kNo, kYes };

/// The maps that runs are shown on.
struct TracedPlace {
  std::string name;
  OccupancyGrid occupancy;
  FieldMap field;
};

/// What one method said, scan after scan.
struct TracedMethod {
  std::string name;
  std::vector<Estimate> estimates;
};

/// A scan as it was seen from the robot.
struct TracedScan {
  Stamp stamp;
  PointSet points_base_m;
};

/// Everything that is needed to look at a run again: where the robot truly was (empty where nobody knows),
/// what its laser saw, and what each method made of it.
struct RunTrace {
  std::string name;
  std::shared_ptr<const TracedPlace> place;
  Trajectory truth;
  std::vector<TracedScan> scans;
  std::vector<TracedMethod> methods;
};

/// Keeps scans of a run as it goes by, thinned: however long it lasts, no more than about `most`, at equal
/// steps of time, and of each scan some 90 points.
class ScanRecorder {
 public:
  explicit ScanRecorder(const Rig& rig, std::size_t most = 600) : rig_(rig), most_(most) {}
  void observe(const SensorEvent& event);
  std::vector<TracedScan> take() { return std::move(scans_); }

 private:
  Rig rig_;
  std::size_t most_;
  double every_s_ = 0.2;
  std::vector<TracedScan> scans_;
};

}  // namespace mstsl
