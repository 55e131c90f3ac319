#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "mstsl/core/random.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/datasets/dataset.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/mapping/occupancy_mapper.hpp"
#include "mstsl/sim/survey.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::datasets {

/// A log of a real robot: scans, the pose that SLAM gave each of them, and what the wheels said.
struct CarmenLog {
  Rig rig;
  std::vector<LaserScan> scans;
  std::vector<PoseReading> corrected;  ///< of the scan of the same number, at its stamp
  std::vector<OdometryReading> odometry;
};

/// Reads one log (`*-corrected.log`, packed or not). Errors: as io::play; fewer than two scans with a pose.
Result<CarmenLog> read_carmen_log(const std::filesystem::path& file);

struct CarmenOptions {
  RunOptions runs = {.count = 20, .length_m = 12.0};
  double mapped_share = 0.6;  ///< the first part of the way, in shares of its length: it makes map and survey
  double clearance_m =
      0.2;  ///< a later pose nearer to a mapped wall, or off the mapped free ground, is not a revisit
  double near_m = 2.0;  ///< nor is one farther than this from the first part's way
  bool drive_lanes =
      true;  ///< besides the recorded way the survey drives every lane of the map, as the paper's did
  MappingOptions mapping;
  sim::WorldOptions world;  ///< the steel
  sim::SurveyOptions lanes;
  sim::RobotOptions robot;  ///< its magnetometer; for lanes, how it drives
};

/// How much of a log's later part comes back to where its first part was.
struct Revisits {
  std::size_t first_later_scan = 0;
  double first_m = 0.0;  ///< length of the first part
  double later_m = 0.0;
  double within_1m_share = 0.0;  ///< of the later scans: taken less than 1 m from the first part's way
  std::vector<bool> follows;     ///< per scan: it and the one before are later ones and revisits
  std::size_t revisiting = 0;    ///< later scans that are revisits
};

Revisits find_revisits(std::span<const PoseReading> corrected, const OccupancyGrid& first_map,
                       const CarmenOptions& options);

/// Where the first part ends: the first scan beyond that share of the way.
std::size_t first_scan_after(std::span<const PoseReading> corrected, double share);

/// Real lidar and odometry, simulated field. The first part of the log makes the map; the field is that of
/// steel placed over its walls; runs are stretches of the later part that revisit the mapped ground, with the
/// real scans and the wheels' real odometry. Truth is the log's corrected poses. Errors: a later part that
/// does not revisit enough.
Result<Dataset> carmen(const std::filesystem::path& file, const CarmenOptions& options, const Random& random);

}  // namespace mstsl::datasets
