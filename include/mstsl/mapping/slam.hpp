#pragma once

#include <cstddef>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/mapping/bent_track.hpp"
#include "mstsl/mapping/loop_closer.hpp"
#include "mstsl/mapping/pose_graph.hpp"
#include "mstsl/mapping/scan_chain.hpp"

namespace mstsl {

struct SlamOptions {
  ScanChainOptions chain;
  LoopCloserOptions loops;
  PoseGraphOptions graph;
};

/// Where the robot was on a drive through a building of which nothing was known.
struct SlamTrack {
  /// At each odometry reading and each matched scan; the map's origin is the base at the first scan.
  Trajectory map_T_base;
  std::vector<TimedPose> keyframes;
  std::vector<Closure> closures;
  LoopCounts loops;
  WheelCalibration wheels;
  double way_m = 0.0;
  double mean_score = 0.0;  ///< of scans matched to those just before them, 0 .. 1
  std::size_t scans = 0;
  std::size_t breaks = 0;   ///< of odometry
};

/// Simultaneous localization and mapping of one drive: a chain of keyframes (ScanChain), loops found by scans
/// and field together (LoopCloser), all poses by least squares (PoseGraph). Feed it in time order; the answer
/// is given at the end.
class Slam {
 public:
  explicit Slam(const Rig& rig, const SlamOptions& options = {});

  void observe(const OdometryReading& odometry) { chain_.observe(odometry), advance(); }
  void observe(const OdometryRestart& restart) { chain_.observe(restart); }
  void observe(const LaserScan& scan) { chain_.observe(scan), advance(); }
  void observe(const FieldReading& field) { chain_.observe(field); }

  /// Errors: no odometry, no scan near a time with odometry.
  Result<SlamTrack> finish();

 private:
  void advance();
  void add(const Keyframe& keyframe);
  void optimise();
  /// Where odometry had the robot at each matched scan, and where it was.
  std::vector<TrackKnot> scans_on_track(const Trajectory& scans) const;

  SlamOptions options_;
  ScanChain chain_;
  LoopCloser loops_;
  PoseGraph graph_;
  struct Kept {
    Stamp stamp;
    Pose2 track_T_base, chain_T_base;
    double score;
  };
  std::vector<Kept> kept_;
  std::size_t optimised_at_ = 0;  ///< poses then
  bool closed_since_ = false;
};

}  // namespace mstsl
