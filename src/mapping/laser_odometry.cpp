#include "mstsl/mapping/laser_odometry.hpp"

#include <algorithm>
#include <cmath>

namespace mstsl {

LaserOdometry::LaserOdometry(const Rig& rig, const LaserOdometryOptions& options)
    : rig_(rig), options_(options), walls_(options.recent_m) {}

std::optional<OdometryReading> LaserOdometry::observe(const LaserScan& scan) {
  if (last_ && scan.stamp - *last_ < options_.every_s) return std::nullopt;
  std::vector<BeamReturn> returns = beam_returns(scan, rig_.base_T_laser, motion_);
  std::erase_if(returns,
                [&](const BeamReturn& r) { return (r.point_m - r.origin_m).norm() > options_.max_range_m; });
  const std::vector<FacedPoint> faced = faced_points(returns);
  const PointSet points = at_most(thinned(places_of(faced), 0.1), 250);
  if (last_) {
    const double seconds = scan.stamp - *last_;
    // As fast as a moment ago; after a gap nothing is known of that.
    const bool goes_on = interval_s_ > 0.0 && seconds < 3.0 * interval_s_;
    const double times = goes_on ? seconds / interval_s_ : 0.0;
    const Pose2 expected{times * motion_.x, times * motion_.y, times * motion_.yaw};
    const Pose2 from = odom_T_base_;
    const double wide_s = std::min(1.0, goes_on ? seconds : 2.0 * seconds);
    const double shift_sd_m = 0.005 + wide_s * options_.speed_sd_m_s;
    const Eigen::Vector3d sd(shift_sd_m, shift_sd_m, 0.005 + wide_s * options_.turn_rate_sd_rad_s);
    const PosePrior prior{from * expected, sd.cwiseAbs2().asDiagonal()};
    WallFit fit = fit_to_walls(walls_.walls(), points, prior, options_.fit);
    if (fit.score < options_.search_below) {
      const WallFit around = fit_around(walls_.walls(), points, prior.mean, options_.around, options_.fit);
      if (around.score > fit.score + 0.1) fit = around;
    }
    odom_T_base_ = fit.map_T_base;
    motion_ = between(from, odom_T_base_);
    interval_s_ = seconds;
  }
  constexpr double kDrawn_m = 0.25, kDrawn_rad = 0.15;
  if (!last_ || distance(drawn_, odom_T_base_) > kDrawn_m ||
      std::abs(angle_between(drawn_.yaw, odom_T_base_.yaw)) > kDrawn_rad) {
    walls_.add(faced, odom_T_base_);
    drawn_ = odom_T_base_;
  }
  last_ = scan.stamp;
  return OdometryReading{scan.stamp, odom_T_base_};
}

}  // namespace mstsl
