#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/scan/likelihood_field.hpp"
#include "mstsl/scan/log_odds_grid.hpp"
#include "mstsl/scan/points.hpp"
#include "mstsl/scan/refine.hpp"

namespace mstsl {

/// Odometry's error over a motion, as standard deviations that add up in squares. The defaults cover the
/// recovered odometry of real robots (ACES, Intel, Freiburg: 4-7 cm and 2-3 deg over a step of half a metre).
struct OdometryNoise {
  double m_per_m = 0.10;
  double rad_per_m = 0.08;
  double rad_per_rad = 0.08;
  double floor_m = 0.002;    ///< at every step, also when standing
  double floor_rad = 0.002;  ///< likewise

  /// Of the motion's x, y (m) and yaw (rad), in the frame it starts from.
  Eigen::Matrix3d covariance(const Pose2& motion) const;
};

struct LocalMapOptions {
  double resolution_m = 0.05;  ///< the paper's cell size
  /// Half the side of the square (m), the first pose in its middle: 10 m driven (the paper's limit) and 10 m
  /// of view.
  double half_size_m = 20.0;
  /// A scan is drawn into the map after this much motion since the last one drawn; those between are only
  /// aligned.
  double keyframe_distance_m = 0.2;
  double keyframe_angle_rad = 0.17;
  /// Points nearer each other than this count once (m), and a scan is aligned by no more than so many of
  /// them.
  double spacing_m = 0.10;
  std::size_t max_points = 250;
  /// A return farther than this from both its neighbours (m), as on a wall seen at a grazing angle, is not
  /// used: the dots that it would draw move along with the robot and hold the next scan back.
  double max_gap_m = 0.25;
  OdometryNoise odometry = {};
  BeamModel beams = {};
  LikelihoodOptions likelihood = {};
  /// Each point counts: a scan and the map drawn of the same walls a moment ago share few errors.
  RefineOptions refine = {.points_per_error = 1.0};
};

/// The paper's local map M_L,k: each incoming scan is aligned with the map drawn so far, from odometry's
/// prediction, and drawn into it. Its frame `local` is the base at the first scan. It depends on the sensors
/// only and not on where in the building the robot is: a hypothesis k only says where `local` lies in the
/// map. So ONE local map serves all K hypotheses, map_T_base = map_T_local(k) * local_T_base, and the paper's
/// K local maps are its K rigid copies.
class LocalMap {
 public:
  explicit LocalMap(const LocalMapOptions& options = {});

  /// Takes a scan's returns in the base frame, and the base's motion since the last scan by odometry. A scan
  /// without returns only moves the base. Expects a finite motion.
  void insert(const std::vector<BeamReturn>& returns_base, const Pose2& last_T_base);

  bool empty() const { return !has_scan_; }
  /// Where the base is, in the local frame.
  const Pose2& local_T_base() const { return local_T_base_; }

  /// Points on the walls drawn so far, thinned; whatever beams have since passed through (people) is left
  /// out.
  PointSet points_in_local() const;
  /// The same as seen from the base: what match_submap() looks for in the global map.
  PointSet points_in_base() const;

  /// The drawn map in the local frame: free where beams passed, occupied where they ended.
  OccupancyGrid occupancy() const;

 private:
  void align(const PointSet& points_base, const Pose2& last_T_base);
  void draw(const std::vector<BeamReturn>& returns_base, const PointSet& points_base);
  bool has_moved_since_drawn() const;
  PointSet points_over_drawn(const PointSet& points_base, const Pose2& local_T_base) const;

  LocalMapOptions options_;
  LogOddsGrid drawn_;
  LikelihoodField field_;
  PointSet points_local_;
  Pose2 local_T_base_;
  Eigen::Matrix3d covariance_ =
      Eigen::Matrix3d::Zero();  ///< of the alignment alone; it does not see the map drift
  Pose2 local_T_drawn_;
  bool has_scan_ = false;
};

}  // namespace mstsl
