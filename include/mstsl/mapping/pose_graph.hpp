#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/parallel.hpp"
#include "mstsl/core/pose2.hpp"
#include "mstsl/mapping/wheels.hpp"

namespace mstsl {

/// How a pose hangs on the one before it. Informations are on (x, y, yaw) of the motion, in the axes of its
/// start; zero where nothing is known.
struct ChainLink {
  Pose2 by_wheels;
  Eigen::Matrix3d wheels_information = Eigen::Matrix3d::Zero();
  Pose2 by_scans;  ///< along what scans do not tell, as the wheels have it
  Eigen::Matrix3d scans_information = Eigen::Matrix3d::Zero();
};

/// Two poses seen to be near each other, long after one another.
struct Closure {
  std::size_t from = 0, to = 0;
  Pose2 from_T_to;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< on (x, y, yaw) in the axes of `from`
  bool by_field = false;                                  ///< the field had a say in it
  double probability = 0;                                 ///< of being right, when it was made
  bool refuted = false;                                   ///< all the others together say that it is wrong
};

struct PoseGraphOptions {
  WheelCalibration wheels_sd{.scale = 0.05, .drift_rad_per_m = 0.035, .turn_scale = 0.05};
  /// A closure this many standard deviations (of all its three numbers together) off is refuted.
  double refuted_beyond = 5.0;
  int max_iterations = 30;
  Threads threads;
};

/// Poses along drives, tied by what wheels and scans say of neighbours and by closures between distant ones:
/// the most probable poses of all (Lu & Milios 1997), with the wheels' calibration, by least squares (Ceres)
/// with robust losses on scans and closures.
class PoseGraph {
 public:
  explicit PoseGraph(const PoseGraphOptions& options = {}) : options_(options) {}

  /// Appends a pose that hangs on the last one, or not at all where the link knows nothing; the first pose of
  /// all is the map's origin.
  void add(const ChainLink& link);
  void add(const Closure& closure);
  /// Moves the poses from `first` on as one rigid piece, so that pose `i` of them comes to `to`.
  void move_tail(std::size_t first, std::size_t i, const Pose2& to);

  /// Moves all poses to where they are most probable; closures that then do not fit are refuted and left
  /// out.
  void optimise();

  std::size_t size() const { return poses_.size(); }
  const Pose2& pose(std::size_t i) const { return poses_[i]; }
  const std::vector<Closure>& closures() const { return closures_; }
  const WheelCalibration& wheels() const { return wheels_; }

  /// How well the poses of some earlier nodes relative to the last one are known: for each the covariance (x,
  /// y, yaw; in the axes of the last pose) along the best known way through the graph (Olson 2008, Dijkstra
  /// projection): a little too large where several ways lead there. Looks no farther than it has to.
  std::vector<Eigen::Matrix3d> covariances_from_last(std::span<const std::size_t> nodes) const;

 private:
  struct Edge {
    std::size_t to;
    Eigen::Matrix3d covariance;  ///< of this_T_to, in the axes of this
  };
  std::vector<Edge> edges_of(std::size_t i) const;
  void solve();
  bool refute();

  PoseGraphOptions options_;
  std::vector<Pose2> poses_;
  std::vector<ChainLink> links_;  ///< links_[i] leads from pose i - 1 to pose i
  std::vector<Eigen::Matrix3d> link_covariances_;
  std::vector<Closure> closures_;
  std::vector<Eigen::Matrix3d> closure_covariances_;
  std::vector<std::vector<std::size_t>> closures_at_;  ///< of each pose
  WheelCalibration wheels_;
};

}  // namespace mstsl
