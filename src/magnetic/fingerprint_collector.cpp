#include "mstsl/magnetic/fingerprint_collector.hpp"

#include <cmath>
#include <utility>

#include "mstsl/core/angles.hpp"

namespace mstsl {

FingerprintCollector::FingerprintCollector(const Rig& rig, const CollectorOptions& options)
    : rig_(rig), options_(options) {}

void FingerprintCollector::observe(const PoseReading& pose) {
  if (!pose.map_T_base.is_finite() || (last_pose_ && pose.stamp <= last_pose_->stamp)) {
    ++report_.bad_poses;
    return;
  }
  if (last_pose_) join(*last_pose_, pose);
  last_pose_ = pose;
}

void FingerprintCollector::observe(const FieldReading& reading) {
  ++report_.readings;
  if (!reading.sensor_field_uT.allFinite()) {
    ++report_.not_finite;
  } else if (last_reading_ && reading.stamp < *last_reading_) {
    ++report_.out_of_order;
  } else if (!last_pose_ || reading.stamp < last_pose_->stamp) {
    // Its pose is past: known only to lie before the first one, or delivered after a newer pose was used.
    ++(last_pose_ ? report_.out_of_order : report_.without_pose);
  } else if (reading.stamp - last_pose_->stamp > options_.max_pose_gap_s) {
    ++report_.in_pose_gap;
    close_fingerprint();
  } else {
    last_reading_ = reading.stamp;
    waiting_.push_back(reading);
  }
}

void FingerprintCollector::join(const PoseReading& from, const PoseReading& to) {
  const double gap_s = to.stamp - from.stamp;
  if (gap_s > options_.max_pose_gap_s) return interrupt(report_.in_pose_gap);
  if (distance(from.map_T_base, to.map_T_base) > options_.max_speed_m_s * gap_s)
    return interrupt(report_.at_pose_jump);
  for (const FieldReading& reading : std::exchange(waiting_, {})) {
    const Pose2 map_T_base =
        interpolate(from.map_T_base, to.map_T_base, (reading.stamp - from.stamp) / gap_s);
    const Eigen::Isometry3d map_T_sensor = to_isometry3(map_T_base) * rig_.base_T_magnetometer;
    add({map_T_sensor.translation().head<2>(), map_T_sensor.linear() * reading.sensor_field_uT,
         map_T_base.yaw});
  }
}

void FingerprintCollector::add(const Sample& sample) {
  ++report_.used;
  double carried_m = 0.0;
  if (open_) {
    const double travel_m = open_->carried_m + (sample.position_m - open_->first.position_m).norm();
    const double turn_rad = angle_between(open_->first.heading_rad, sample.heading_rad);
    if (travel_m >= options_.spacing_m) carried_m = std::fmod(travel_m, options_.spacing_m);
    if (travel_m >= options_.spacing_m || std::abs(turn_rad) >= options_.turn_rad) close_fingerprint();
  }
  if (!open_) open_ = Open{sample, {}, 0.0, carried_m};
  open_->sum.position_m += sample.position_m;
  open_->sum.field_uT += sample.field_uT;
  open_->sum.heading_rad += angle_between(open_->first.heading_rad, sample.heading_rad);
  open_->count += 1.0;
}

void FingerprintCollector::close_fingerprint() {
  if (!open_) return;
  const auto& [first, sum, count, carried_m] = *open_;
  fingerprints_.push_back({sum.position_m / count, sum.field_uT / count,
                           wrap_angle(first.heading_rad + sum.heading_rad / count), session_});
  open_.reset();
}

/// The drive is broken here: what waits for a pose gets none, and no fingerprint spans the break.
void FingerprintCollector::interrupt(std::uint64_t& counter) {
  counter += waiting_.size();
  waiting_.clear();
  close_fingerprint();
}

void FingerprintCollector::start_session(const Rig& rig) {
  interrupt(report_.without_pose);
  last_pose_.reset();
  last_reading_.reset();
  rig_ = rig;
  ++session_;
}

std::vector<Fingerprint> FingerprintCollector::finish() {
  interrupt(report_.without_pose);
  return std::exchange(fingerprints_, {});
}

}  // namespace mstsl
