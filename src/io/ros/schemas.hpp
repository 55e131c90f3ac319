#pragma once

#include <string>
#include <string_view>

namespace mstsl::io::ros {

/// "sensor_msgs/LaserScan" as ROS 2 names it: "sensor_msgs/msg/LaserScan".
std::string ros2_type_name(std::string_view type);

/// The package/Name form of a type as either ROS writes it.
std::string plain_type_name(std::string_view type);

/// The definition of a message type (package/Name) with those it depends on, in the "ros2msg" form of ROS 2
/// logs: separated by lines of 80 '=' and "MSG: package/Name". Empty for a type that is not ours.
std::string ros2msg_schema(std::string_view type);

}  // namespace mstsl::io::ros
