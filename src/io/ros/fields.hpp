#pragma once

#include "io/ros/messages.hpp"

/// The layout of each message, said once: its fields in the order in which both ROS 1 and ROS 2 write them.
/// An archive (a reader or a writer of one of the encodings) is called with the fields and knows how to treat
/// numbers, texts, fixed arrays, sequences and, by coming back here, nested messages.
namespace mstsl::io::ros {

template <typename Archive>
void fields(Archive& archive, Header& m) {
  archive.sequence_number();
  archive(m.stamp, m.frame_id);
}
template <typename Archive>
void fields(Archive& archive, Vector3& m) {
  archive(m.x, m.y, m.z);
}
template <typename Archive>
void fields(Archive& archive, Quaternion& m) {
  archive(m.x, m.y, m.z, m.w);
}
template <typename Archive>
void fields(Archive& archive, Pose& m) {
  archive(m.position, m.orientation);
}
template <typename Archive>
void fields(Archive& archive, PoseWithCovariance& m) {
  archive(m.pose, m.covariance);
}
template <typename Archive>
void fields(Archive& archive, TwistWithCovariance& m) {
  archive(m.linear, m.angular, m.covariance);
}
template <typename Archive>
void fields(Archive& archive, LaserScan& m) {
  archive(m.header, m.angle_min, m.angle_max, m.angle_increment, m.time_increment, m.scan_time, m.range_min,
          m.range_max, m.ranges, m.intensities);
}
template <typename Archive>
void fields(Archive& archive, MagneticField& m) {
  archive(m.header, m.magnetic_field, m.magnetic_field_covariance);
}
template <typename Archive>
void fields(Archive& archive, Imu& m) {
  archive(m.header, m.orientation, m.orientation_covariance, m.angular_velocity,
          m.angular_velocity_covariance, m.linear_acceleration, m.linear_acceleration_covariance);
}
template <typename Archive>
void fields(Archive& archive, Odometry& m) {
  archive(m.header, m.child_frame_id, m.pose, m.twist);
}
template <typename Archive>
void fields(Archive& archive, PoseStamped& m) {
  archive(m.header, m.pose);
}
template <typename Archive>
void fields(Archive& archive, PoseWithCovarianceStamped& m) {
  archive(m.header, m.pose);
}
template <typename Archive>
void fields(Archive& archive, TransformStamped& m) {
  archive(m.header, m.child_frame_id, m.translation, m.rotation);
}
template <typename Archive>
void fields(Archive& archive, TFMessage& m) {
  archive(m.transforms);
}

}  // namespace mstsl::io::ros
