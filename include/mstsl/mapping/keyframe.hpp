#pragma once

#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/stamp.hpp"
#include "mstsl/localize/joint/step.hpp"
#include "mstsl/scan/scanned_walls.hpp"

namespace mstsl {

/// A place on a drive whose scan is kept, and how it hangs on the one before.
struct Keyframe {
  Stamp stamp;
  double travelled_m = 0.0;  ///< since the drive began
  Pose2 track_T_base;        ///< by the wheels alone
  Pose2 chain_T_base = {};   ///< by matching each scan to those just before it: smooth, but drifting
  bool broken = false;       ///< what the wheels say of the way since the keyframe before is not known
  /// Of the match with the scans just before, on (x, y, yaw) in the base's axes here; zero where the scan
  /// tells nothing.
  Eigen::Matrix3d scan_information = Eigen::Matrix3d::Zero();
  double score = 0.0;                          ///< of that match (WallFit::score)
  std::vector<FacedPoint> points_base_m = {};  ///< of its scan, thinned
  std::vector<joint::Station> stations = {};   ///< the field since the keyframe before
};

}  // namespace mstsl
