#include "io/log/ros_events.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "io/log/frame_tree.hpp"

namespace mstsl::io {
namespace {

Eigen::Vector3d to_vector(const ros::Vector3& v) { return {v.x, v.y, v.z}; }

/// A quaternion rounded to 32 bits, or printed with two digits, is still within this of unit length.
constexpr double kUnitTolerance = 0.02;

/// The unit quaternion; nothing when it is not finite or its length is too far from one.
std::optional<Eigen::Quaterniond> to_rotation(const ros::Quaternion& q) {
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  const double length = rotation.norm();
  if (!(std::abs(length - 1.0) <= kUnitTolerance)) return std::nullopt;
  return rotation.normalized();
}

bool has_sound_geometry(const ros::LaserScan& scan) {
  const bool finite = std::isfinite(scan.angle_min) && std::isfinite(scan.angle_increment) &&
                      std::isfinite(scan.time_increment) && std::isfinite(scan.range_min) &&
                      !std::isnan(scan.range_max);
  return finite && (scan.angle_increment != 0.0F || scan.ranges.size() == 1);
}

}  // namespace

std::optional<Eigen::Isometry3d> to_isometry(const ros::Vector3& translation,
                                             const ros::Quaternion& rotation) {
  const std::optional<Eigen::Quaterniond> unit = to_rotation(rotation);
  const Eigen::Vector3d offset = to_vector(translation);
  if (!unit || !offset.allFinite()) return std::nullopt;
  return Eigen::Translation3d(offset) * *unit;
}

std::optional<SensorEvent> RosEvents::make(const RawMessage& message) {
  const std::string& topic = message.channel->topic;
  ++report_->messages[topic];
  if (topic == topics_.scan) return scan(message);
  if (topic == topics_.magnetic_field) return field(message);
  if (topic == topics_.odometry) return odometry(message);
  if (topic == topics_.imu) return imu(message);
  if (topic == topics_.pose) return pose(message);
  return std::nullopt;
}

std::nullopt_t RosEvents::drop(std::string_view kind, std::string_view why) {
  ++report_->problems[fmt::format("{} {} dropped", kind, why)];
  return std::nullopt;
}

template <typename Message>
std::optional<Message> RosEvents::decode(const RawMessage& message) {
  std::optional<Message> decoded = ros::decode<Message>(message.channel->encoding, message.data);
  if (!decoded) drop("messages", "that are cut short");
  return decoded;
}

Stamp RosEvents::stamp(const ros::Header& header, const RawMessage& message) {
  const Stamp stamp = Stamp::from_parts(header.stamp.sec, header.stamp.nanosec);
  if (stamp.ns > 0) return stamp;
  ++report_->problems["messages without a stamp, taken at the time of recording"];
  return message.log_time;
}

std::optional<SensorEvent> RosEvents::scan(const RawMessage& message) {
  std::optional<ros::LaserScan> scan = decode<ros::LaserScan>(message);
  if (!scan) return std::nullopt;
  if (frame_name(scan->header.frame_id) != setup_.scan_frame) return drop("scans", "of another frame");
  if (scan->ranges.empty()) return drop("scans", "without beams");
  if (!has_sound_geometry(*scan)) return drop("scans", "with impossible angles or limits");
  return LaserScan{.stamp = stamp(scan->header, message),
                   .angle_min_rad = scan->angle_min,
                   .angle_increment_rad = scan->angle_increment,
                   .time_increment_s = scan->time_increment,
                   .range_min_m = scan->range_min,
                   .range_max_m = scan->range_max,
                   .ranges_m = std::move(scan->ranges)};
}

std::optional<SensorEvent> RosEvents::field(const RawMessage& message) {
  const std::optional<ros::MagneticField> field = decode<ros::MagneticField>(message);
  if (!field) return std::nullopt;
  if (frame_name(field->header.frame_id) != setup_.magnetic_frame)
    return drop("magnetic readings", "of another frame");
  const Eigen::Vector3d value = to_vector(field->magnetic_field);
  if (!value.allFinite()) return drop("magnetic readings", "that are not finite");
  return FieldReading{stamp(field->header, message), value * setup_.microtesla_per_unit};
}

std::optional<Pose2> RosEvents::planar(const ros::Pose& pose, std::string_view kind) {
  if (!to_vector(pose.position).allFinite()) return drop(kind, "that are not finite");
  const std::optional<Eigen::Isometry3d> motion = to_isometry(pose.position, pose.orientation);
  if (!motion) return drop(kind, "whose quaternion is not of unit length");
  return to_pose2(*motion);
}

std::optional<SensorEvent> RosEvents::odometry(const RawMessage& message) {
  const std::optional<ros::Odometry> odometry = decode<ros::Odometry>(message);
  if (!odometry) return std::nullopt;
  const std::optional<Pose2> pose = planar(odometry->pose.pose, "odometry readings");
  if (!pose) return std::nullopt;
  return OdometryReading{stamp(odometry->header, message), *pose};
}

std::optional<SensorEvent> RosEvents::imu(const RawMessage& message) {
  const std::optional<ros::Imu> imu = decode<ros::Imu>(message);
  if (!imu) return std::nullopt;
  if (frame_name(imu->header.frame_id) != setup_.imu_frame)
    return drop("inertial readings", "of another frame");
  const Eigen::Vector3d rate = to_vector(imu->angular_velocity);
  if (!rate.allFinite()) return drop("inertial readings", "that are not finite");
  ImuReading reading{stamp(imu->header, message), setup_.magnetometer_q_imu * rate, std::nullopt};
  const bool has_orientation = imu->orientation_covariance.front() != -1.0;
  if (const auto world_q_imu = to_rotation(imu->orientation); has_orientation && world_q_imu)
    reading.world_q_sensor = *world_q_imu * setup_.magnetometer_q_imu.conjugate();
  return reading;
}

std::optional<SensorEvent> RosEvents::pose(const RawMessage& message) {
  const auto read = [&](const ros::Header& header, const ros::Pose& pose) -> std::optional<SensorEvent> {
    const std::optional<Pose2> map_T_base = planar(pose, "poses");
    if (!map_T_base) return std::nullopt;
    return PoseReading{stamp(header, message), *map_T_base};
  };
  if (message.channel->type == ros::Odometry::kType) {
    const auto decoded = decode<ros::Odometry>(message);
    return decoded ? read(decoded->header, decoded->pose.pose) : std::nullopt;
  }
  if (message.channel->type == ros::PoseWithCovarianceStamped::kType) {
    const auto decoded = decode<ros::PoseWithCovarianceStamped>(message);
    return decoded ? read(decoded->header, decoded->pose.pose) : std::nullopt;
  }
  const auto decoded = decode<ros::PoseStamped>(message);
  return decoded ? read(decoded->header, decoded->pose) : std::nullopt;
}

}  // namespace mstsl::io
