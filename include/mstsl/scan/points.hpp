#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/sensor_data.hpp"

namespace mstsl {

/// Points in the plane (m), in a frame that the name of the variable says.
using PointSet = std::vector<Eigen::Vector2d>;

/// One return: where the beam began and where it ended, seen from above in the base frame (m).
struct BeamReturn {
  Eigen::Vector2d origin_m;
  Eigen::Vector2d point_m;
};

/// From the first beam's instant to the last's (s); 0 for a scan without time increments or beams.
double sweep_duration_s(const LaserScan& scan);

/// A scan's returns in the frame base_link as it stood at `scan.stamp`, in beam order. Beams without a return
/// (NaN, infinite, outside [range_min_m, range_max_m]) are dropped; a hostile scan gives fewer or no returns,
/// never a point that is not finite. `base_T_laser` is the full mounting: a laser that hangs upside down or
/// tilts is normal, and points are seen from above. `first_T_last` is the base's motion from the first beam
/// to the last (from odometry), which de-skews the sweep, at even speed; leave it out for a robot that stands
/// or a scan taken at one instant.
std::vector<BeamReturn> beam_returns(const LaserScan& scan, const Eigen::Isometry3d& base_T_laser,
                                     const Pose2& first_T_last = {});

PointSet end_points(const std::vector<BeamReturn>& returns);

/// end_points(beam_returns(...)).
PointSet points_in_base(const LaserScan& scan, const Eigen::Isometry3d& base_T_laser,
                        const Pose2& first_T_last = {});

/// The same points in frame a: a_T_b * p for each.
PointSet transformed(const Pose2& a_T_b, const PointSet& points_b);

/// Fewer points of the same shape: in the given order, each point is kept unless one already kept lies nearer
/// than `spacing_m`. So a near wall, hit by many beams, counts no more than a far one of the same length. The
/// choice does not change under rigid motions. spacing_m <= 0 keeps all.
PointSet thinned(const PointSet& points, double spacing_m);

/// At most `count` of the points, spread evenly over their order.
PointSet at_most(const PointSet& points, std::size_t count);

}  // namespace mstsl
