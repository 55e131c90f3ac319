#include "io/ros/schemas.hpp"

#include <algorithm>
#include <vector>

namespace mstsl::io::ros {
namespace {

/// A definition without its dependencies. Types of other packages are written as package/Name, as ROS 2 does.
struct Definition {
  std::string_view type;
  std::string_view text;
};

constexpr Definition kDefinitions[] = {
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    {"geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    {"sensor_msgs/LaserScan",
     "std_msgs/Header header\n"
     "float32 angle_min  # start angle of the scan [rad]\n"
     "float32 angle_max  # end angle of the scan [rad]\n"
     "float32 angle_increment  # angular distance between measurements [rad]\n"
     "float32 time_increment  # time between measurements [seconds]\n"
     "float32 scan_time  # time between scans [seconds]\n"
     "float32 range_min  # minimum range value [m]\n"
     "float32 range_max  # maximum range value [m]\n"
     "float32[] ranges  # range data [m]\n"
     "float32[] intensities  # intensity data [device-specific units]\n"},
    {"sensor_msgs/MagneticField",
     "std_msgs/Header header\n"
     "geometry_msgs/Vector3 magnetic_field  # field vector in Tesla\n"
     "float64[9] magnetic_field_covariance  # row major about x, y, z axes\n"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\n"
     "geometry_msgs/Quaternion orientation\n"
     "float64[9] orientation_covariance  # row major about x, y, z axes\n"
     "geometry_msgs/Vector3 angular_velocity\n"
     "float64[9] angular_velocity_covariance  # row major about x, y, z axes\n"
     "geometry_msgs/Vector3 linear_acceleration\n"
     "float64[9] linear_acceleration_covariance  # row major x, y, z\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\n"
     "string child_frame_id\n"
     "geometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    {"geometry_msgs/PoseWithCovarianceStamped",
     "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
};

std::string_view definition_of(std::string_view type) {
  for (const Definition& definition : kDefinitions)
    if (definition.type == type) return definition.text;
  return {};
}

/// The types of other definitions that a definition uses, and those that they use, each once, in order of
/// first use.
void collect_dependencies(std::string_view text, std::vector<std::string_view>& found) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const std::string_view type = line.substr(0, line.find_first_of(" ["));
    if (type.find('/') == std::string_view::npos || std::ranges::find(found, type) != found.end()) continue;
    found.push_back(type);
    collect_dependencies(definition_of(type), found);
  }
}

}  // namespace

std::string ros2_type_name(std::string_view type) {
  const std::size_t slash = type.find('/');
  if (slash == std::string_view::npos) return std::string(type);
  return std::string(type.substr(0, slash)) + "/msg/" + std::string(type.substr(slash + 1));
}

std::string plain_type_name(std::string_view type) {
  std::string plain(type);
  if (const std::size_t at = plain.find("/msg/"); at != std::string::npos) plain.erase(at, 4);
  return plain;
}

std::string ros2msg_schema(std::string_view type) {
  const std::string_view definition = definition_of(type);
  std::vector<std::string_view> dependencies;
  collect_dependencies(definition, dependencies);
  std::string schema(definition);
  for (const std::string_view dependency : dependencies) {
    schema.append(80, '=').append("\nMSG: ").append(dependency).append("\n");
    schema.append(definition_of(dependency));
  }
  return schema;
}

}  // namespace mstsl::io::ros
