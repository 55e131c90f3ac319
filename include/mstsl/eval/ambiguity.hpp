#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/parallel.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/localize/localization_maps.hpp"

namespace mstsl {

struct AmbiguityOptions {
  double spacing_m = 1.0;    ///< between the places asked about
  double drive_m = 2.0;      ///< driven from each, straight on
  int drives = 2;            ///< from each place, in different directions
  double clearance_m = 0.3;  ///< the robot keeps so far from walls
  /// The robot that drives: as of a small one with a UTM-class laser (docs/joint.md).
  double scan_range_m = 20.0;
  double field_of_view_rad = radians(270.0);
  int beams = 271;
  double range_noise_m = 0.02;
  double bias_sd_uT = 3.0;  ///< of the magnetometer, a drive and an axis
  double noise_uT = 0.3;
  double scale_sd = 0.03, drift_sd_rad_per_m = radians(1.0);  ///< of odometry
  std::uint64_t seed = 1;
  Threads threads;
  std::function<bool(double share)> progress;  ///< false ends it
};

/// How drives from one place ended.
struct AmbiguousPlace {
  Eigen::Vector2d place_m;
  int drives = 0;  ///< 0: no way of that length leads from here
  int right = 0;   ///< answered within the drive, within 0.5 m and 10 deg
  int wrong = 0;   ///< answered wrongly
  /// Share of the drives' way with field readings of a survey near it.
  double field_known = 0.0;
};

/// Where in a building a robot will find itself, computed from its maps alone: drives of a few metres are
/// made up from them (scans cast in the occupancy map, the field as the field map has it, off by as much as
/// it says it may be) and given to the joint method. What the maps do not know (people, moved things) is not
/// in it. It shows where to survey again, or where to put a piece of iron; shares are on the low side
/// (docs/mapping.md).
/// Errors: an end asked for.
Result<std::vector<AmbiguousPlace>> find_ambiguity(std::shared_ptr<const LocalizationMaps> maps,
                                                   const AmbiguityOptions& options = {});

}  // namespace mstsl
