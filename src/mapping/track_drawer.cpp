#include "mstsl/mapping/track_drawer.hpp"

#include <cmath>

#include "mstsl/core/angles.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl {

void TrackDrawer::begin_drive(const Rig& rig, const Trajectory& map_T_base) {
  rig_ = rig;
  map_T_base_ = &map_T_base;
  last_.reset();
}

void TrackDrawer::observe(const LaserScan& scan) {
  constexpr double kLongestGap_s = 1.0;
  if (error_ || map_T_base_ == nullptr) return;
  const auto pose = map_T_base_->at(scan.stamp, kLongestGap_s);
  if (!pose) return;
  if (last_ && distance(last_->pose, *pose) < options_.every_m &&
      std::abs(angle_between(last_->pose.yaw, pose->yaw)) < options_.every_rad &&
      scan.stamp - last_->stamp < options_.every_s)
    return;
  last_ = {scan.stamp, *pose};
  const auto end = map_T_base_->at(scan.stamp + sweep_duration_s(scan), kLongestGap_s);
  const auto drawn = mapper_.insert(scan, rig_.base_T_laser, *pose, between(*pose, end.value_or(*pose)));
  if (!drawn) error_ = drawn.error();
}

Result<OccupancyGrid> TrackDrawer::grid() const {
  if (error_) return *error_;
  return mapper_.grid();
}

}  // namespace mstsl
