#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/mapping/bent_track.hpp"
#include "mstsl/mapping/laser_odometry.hpp"
#include "mstsl/mapping/loop_closer.hpp"
#include "mstsl/mapping/pose_graph.hpp"
#include "mstsl/mapping/scan_chain.hpp"

namespace mstsl {

struct SlamOptions {
  bool without_wheels = false;  ///< the log has no odometry: the laser must do
  ScanChainOptions chain;
  LoopCloserOptions loops;
  PoseGraphOptions graph;
};

/// Where a drive was at some time, in the map of the drives before it.
struct Anchor {
  Stamp stamp;
  Pose2 map_T_base;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< x, y, yaw; map frame
};

/// Where the robot was on one drive.
struct DriveTrack {
  Trajectory map_T_base;  ///< at each matched scan, and often enough between (ThinnedTrack)
  double way_m = 0.0;
  std::size_t scans = 0;
  std::size_t breaks = 0;  ///< of odometry
};

/// Where the robot was on drives through a building of which nothing was known. The map's origin is the base
/// at the first scan of the first drive.
struct SlamTrack {
  std::vector<DriveTrack> drives;
  struct Keyframe {
    std::size_t drive;
    Stamp stamp;
    Pose2 map_T_base;
  };
  std::vector<Keyframe> keyframes;
  std::vector<Closure> closures;  ///< between keyframes
  LoopCounts loops;
  WheelCalibration wheels;
  double mean_score = 0.0;  ///< of scans matched to those just before them, 0 .. 1

  double way_m() const;
  std::size_t scans() const;
};

/// Simultaneous localization and mapping: chains of keyframes (ScanChain), loops found by scans and field
/// together (LoopCloser), all poses by least squares (PoseGraph). Feed it a drive in time order; then
/// another, if it is known where that was at some time.
class Slam {
 public:
  explicit Slam(const SlamOptions& options = {});

  /// What follows is one drive. All but the first need an anchor.
  void begin_drive(const Rig& rig, const std::optional<Anchor>& anchor = {});
  void observe(const OdometryReading& odometry);
  void observe(const OdometryRestart& restart) { chain().observe(restart); }
  void observe(const LaserScan& scan);
  void observe(const FieldReading& field) { chain().observe(field); }

  /// Ends the drive; where the robot was on all of them so far. Errors: no odometry, no scan near a time with
  /// odometry, a drive that ended before its anchor.
  Result<SlamTrack> track();

 private:
  struct Drive {
    ScanChain chain;
    std::optional<LaserOdometry> laser_odometry;
    std::optional<Anchor> anchor;  ///< until it has been used
    std::size_t first = 0;         ///< of its keyframes
    double begin_m = 0.0;          ///< way of the drives before
  };
  struct Kept {
    std::size_t drive;
    Stamp stamp;
    Pose2 track_T_base, chain_T_base;
    double score;
  };
  ScanChain& chain() { return drives_.back()->chain; }
  void advance();
  void add(Keyframe keyframe);
  void use_anchor(Drive& drive);
  void look();
  void optimise();
  DriveTrack track_of(std::size_t drive) const;

  SlamOptions options_;
  std::vector<std::unique_ptr<Drive>> drives_;
  LoopCloser loops_;
  PoseGraph graph_;
  std::vector<Kept> kept_;
  std::size_t optimised_at_ = 0;  ///< poses then
  bool closed_since_ = false;
};

}  // namespace mstsl
