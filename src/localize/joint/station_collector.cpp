#include "mstsl/localize/joint/station_collector.hpp"

#include <algorithm>
#include <cmath>

namespace mstsl::joint {
namespace {

Eigen::Matrix3d about_z(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

}  // namespace

Eigen::Vector2d StationCollector::sensor_at(const Pose2& track_T_base) const {
  return track_T_base * Eigen::Vector2d(rig_.base_T_magnetometer.translation().head<2>());
}

bool StationCollector::begins_new(const Pose2& track_T_base) const {
  return (sensor_at(track_T_base) - sensor_at(open_->first.pose)).norm() >= options_.spacing_m ||
         std::abs(angle_between(open_->first.pose.yaw, track_T_base.yaw)) >= options_.turn_rad;
}

void StationCollector::add(const FieldReading& reading, const Pose2& track_T_base) {
  if (open_ && begins_new(track_T_base)) close();
  if (!open_)
    open_ = Open{{reading.stamp, track_T_base}, track_T_base, reading.stamp, {0, 0, 0}, {0, 0, 0}, 0};
  const Eigen::Vector3d base_uT = rig_.base_T_magnetometer.linear() * reading.sensor_field_uT;
  const Eigen::Vector3d first_uT = about_z(angle_between(open_->first.pose.yaw, track_T_base.yaw)) * base_uT;
  open_->sum_uT += first_uT;
  open_->squares_uT2 += first_uT.cwiseAbs2();
  open_->last = track_T_base;
  open_->last_stamp = reading.stamp;
  ++open_->readings;
}

void StationCollector::close() {
  const Open open = *open_;
  open_.reset();
  if (open.readings == 0) return;
  const auto n = static_cast<double>(open.readings);
  const Eigen::Vector3d mean = open.sum_uT / n;
  const double scatter = (open.squares_uT2 / n - mean.cwiseAbs2()).cwiseMax(0.0).mean();
  // The mean was taken half-way; its axes are those of the base at the first reading, turned half-way too.
  const Pose2 middle = interpolate(open.first.pose, open.last, 0.5);
  const double turned = angle_between(open.first.pose.yaw, middle.yaw);
  const double seconds = open.last_stamp - open.first.stamp;
  const double forward_m = between(open.first.pose, open.last).x;
  Station station;
  station.base_field_uT = about_z(-turned) * mean;
  station.speed_m_s = seconds > 0.02 ? forward_m / seconds : 0.0;
  station.variance_uT2 = scatter / n;
  const Eigen::Vector2d place_m = sensor_at(middle);
  if (last_place_m_) station.since_last_m = (place_m - *last_place_m_).norm();
  last_place_m_ = place_m;
  ended_.push_back({middle, station});
}

std::vector<Station> StationCollector::take(const Pose2& track_T_base) {
  if (open_ && open_->readings >= options_.min_readings && begins_new(track_T_base)) close();
  std::vector<Station> stations;
  for (Ended& ended : ended_) {
    ended.station.base_T_then = between(track_T_base, ended.track_T_base);
    stations.push_back(ended.station);
  }
  ended_.clear();
  return stations;
}

void StationCollector::interrupt() {
  open_.reset();
  ended_.clear();
  last_place_m_.reset();
}

}  // namespace mstsl::joint
