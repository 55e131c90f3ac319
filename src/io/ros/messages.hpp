#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// The ROS messages that a log of ours carries, as plain structs with the field names and units of ROS's own
/// definitions (std_msgs, geometry_msgs, sensor_msgs, nav_msgs, tf2_msgs).
namespace mstsl::io::ros {

struct Time {
  std::int64_t sec = 0;  ///< signed 32 bits in ROS 2, unsigned 32 in ROS 1
  std::uint32_t nanosec = 0;
};

struct Header {
  Time stamp;
  std::string frame_id;
};

struct Vector3 {  // also geometry_msgs/Point, which has the same fields
  double x = 0.0, y = 0.0, z = 0.0;
};

struct Quaternion {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
};

struct Pose {
  Vector3 position;
  Quaternion orientation;
};

using Covariance3 = std::array<double, 9>;
using Covariance6 = std::array<double, 36>;

struct PoseWithCovariance {
  Pose pose;
  Covariance6 covariance{};
};

struct TwistWithCovariance {
  Vector3 linear, angular;
  Covariance6 covariance{};
};

struct LaserScan {
  static constexpr const char* kType = "sensor_msgs/LaserScan";
  Header header;
  float angle_min = 0.0F, angle_max = 0.0F, angle_increment = 0.0F;
  float time_increment = 0.0F, scan_time = 0.0F;
  float range_min = 0.0F, range_max = 0.0F;
  std::vector<float> ranges, intensities;
};

/// In tesla, as its definition says; what drivers really write is another matter (see detect_unit()).
struct MagneticField {
  static constexpr const char* kType = "sensor_msgs/MagneticField";
  Header header;
  Vector3 magnetic_field;
  Covariance3 magnetic_field_covariance{};
};

struct Imu {
  static constexpr const char* kType = "sensor_msgs/Imu";
  Header header;
  Quaternion orientation;
  Covariance3 orientation_covariance{};  ///< first element -1: the driver gives no orientation
  Vector3 angular_velocity;
  Covariance3 angular_velocity_covariance{};
  Vector3 linear_acceleration;
  Covariance3 linear_acceleration_covariance{};
};

struct Odometry {
  static constexpr const char* kType = "nav_msgs/Odometry";
  Header header;
  std::string child_frame_id;
  PoseWithCovariance pose;
  TwistWithCovariance twist;
};

struct PoseStamped {
  static constexpr const char* kType = "geometry_msgs/PoseStamped";
  Header header;
  Pose pose;
};

struct PoseWithCovarianceStamped {
  static constexpr const char* kType = "geometry_msgs/PoseWithCovarianceStamped";
  Header header;
  PoseWithCovariance pose;
};

struct TransformStamped {
  Header header;
  std::string child_frame_id;
  Vector3 translation;
  Quaternion rotation;
};

struct TFMessage {
  static constexpr const char* kType = "tf2_msgs/TFMessage";
  std::vector<TransformStamped> transforms;
};

}  // namespace mstsl::io::ros
