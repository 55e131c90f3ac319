#pragma once

#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/scan/likelihood_field.hpp"
#include "mstsl/scan/points.hpp"
#include "mstsl/scan/refine.hpp"

namespace mstsl {

struct LocalMapOptions {
  double resolution_m = 0.05;  ///< the paper's cell size
  /// Half the side of the square (m), the first pose in its middle: 10 m driven (the paper's limit) and 10 m
  /// of view.
  double half_size_m = 20.0;
  /// A scan is drawn into the map after this much motion since the last one drawn; those between are only
  /// aligned.
  double keyframe_distance_m = 0.2;
  double keyframe_angle_rad = 0.17;
  /// Scan points this near each other count once in the alignment (m), and no more than so many of them.
  double spacing_m = 0.10;
  std::size_t max_points = 250;
  /// Odometry's error between scans, as standard deviations: per metre driven, per radian turned and per
  /// metre, and a floor. From the recovered odometry of real robots (ACES, Intel, Freiburg): 10 % and 3 deg a
  /// step of 0.5 m.
  double odometry_sigma_m_per_m = 0.10;
  double odometry_sigma_rad_per_rad = 0.10;
  double odometry_sigma_rad_per_m = 0.10;
  double odometry_sigma_floor_m = 0.005;
  double odometry_sigma_floor_rad = 0.005;
  LikelihoodOptions likelihood;
  RefineOptions refine;
};

/// The paper's local map M_L,k: each incoming scan is aligned with the map drawn so far, from odometry's
/// prediction, and drawn into it. Its frame `local` is the base at the first scan. It depends on the sensors
/// only and not on where in the building the robot is: a hypothesis k only says where `local` lies in the
/// map. So ONE local map serves all K hypotheses, map_T_base = map_T_local(k) * local_T_base, and the paper's
/// K local maps are its K rigid copies.
class LocalMap {
 public:
  explicit LocalMap(const LocalMapOptions& options = {});

  /// Takes a scan, whose returns are in the base frame, and the base's motion since the last one by odometry.
  void insert(const std::vector<BeamReturn>& returns_base, const Pose2& last_T_base_odometry);

  bool empty() const { return scans_ == 0; }
  /// Where the base is, in the local frame.
  const Pose2& local_T_base() const { return local_T_base_; }

  /// The wall points found so far, thinned: in the local frame, and as seen from the base.
  PointSet points_in_local() const;
  PointSet points_in_base() const;

  /// The drawn map in the local frame: free where beams passed, occupied where they ended.
  OccupancyGrid occupancy() const;

 private:
  LocalMapOptions options_;
  Grid<float> log_odds_;
  LikelihoodField field_;
  Pose2 local_T_base_;
  Pose2 local_T_keyframe_;
  std::size_t scans_ = 0;
};

}  // namespace mstsl
