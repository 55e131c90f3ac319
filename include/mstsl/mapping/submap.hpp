#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/localize/joint/step.hpp"
#include "mstsl/mapping/keyframe.hpp"
#include "mstsl/scan/match_submap.hpp"
#include "mstsl/scan/scanned_walls.hpp"

namespace mstsl {

/// A reading of the field, seen from a frame that the variable's name says.
struct FieldAt {
  Eigen::Vector2d position_m;  ///< of the magnetometer
  Eigen::Vector3d field_uT;    ///< in the frame's axes
  double heading_rad = 0.0;    ///< of the base in the frame: it turns a bias of the sensor into it
};

/// A stretch of a drive as one rigid piece, seen from the base at its last keyframe: short enough for the
/// chain's drift not to show in it.
struct Stretch {
  PointSet points_m;  ///< of its scans, thinned
  std::vector<FieldAt> fields;
};

/// The stretch made of keyframes, seen from the base at `keyframes[origin]`.
Stretch stretch_of(std::span<const Keyframe> keyframes, std::size_t origin,
                   const Eigen::Vector2d& magnetometer_base_m, double spacing_m);

/// A stretch made ready for finding later scans in it. Frame: the base at its middle keyframe.
struct Submap {
  std::size_t first = 0, last = 0, origin = 0;  ///< keyframes
  int drive = 0;                                ///< of which it is a part: one sensor, one bias
  Eigen::Vector2d magnetometer_base_m{0, 0};    ///< where that drive's magnetometer sits
  double begin_m = 0.0, end_m = 0.0;            ///< travelled
  std::vector<Keyframe> keyframes;              ///< empty once another submap shows the same place
  std::vector<Eigen::Vector2d> way_m;           ///< places of the keyframes in the submap's frame

  /// Of a point, in that frame, from the way.
  double distance_m(const Eigen::Vector2d& point_m) const;
};

/// What matching needs of a submap; made from its keyframes when it is first asked for.
struct SubmapWalls {
  explicit SubmapWalls(const Submap& submap);

  ScannedWalls walls;                     ///< for fitting
  std::unique_ptr<const MatchMap> cells;  ///< for searching, coarser
  std::vector<FieldAt> fields;
};

}  // namespace mstsl
