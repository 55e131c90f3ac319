#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <string_view>

#include "mstsl/io/recording.hpp"
#include "mstsl/io/recording_info.hpp"

#include "info.hpp"
#include "interrupt.hpp"
#include "progress.hpp"

namespace mstsl::app {
namespace {

/// The usual topic where the log has it, else the only one of a fitting type, else none.
std::string topic_for(const io::RecordingInfo& info, const std::string& usual,
                      std::initializer_list<std::string_view> types) {
  std::string found;
  int count = 0;
  for (const io::TopicInfo& topic : info.topics) {
    if (topic.messages == 0 || std::ranges::find(types, topic.type) == types.end()) continue;
    if (topic.name == usual) return usual;
    found = topic.name;
    ++count;
  }
  return count == 1 ? found : "";
}

io::Topics topics_of(const io::RecordingInfo& info) {
  const io::Topics usual;
  if (info.format == "CARMEN log") return usual;
  return {
      .scan = topic_for(info, usual.scan, {"sensor_msgs/LaserScan"}),
      .magnetic_field = topic_for(info, usual.magnetic_field, {"sensor_msgs/MagneticField"}),
      .odometry = topic_for(info, usual.odometry, {"nav_msgs/Odometry"}),
      .transforms_static = topic_for(info, usual.transforms_static, {"tf2_msgs/TFMessage"}),
      .imu = topic_for(info, usual.imu, {"sensor_msgs/Imu"}),
      .pose = topic_for(info, "", {"geometry_msgs/PoseStamped", "geometry_msgs/PoseWithCovarianceStamped"})};
}

Description topic_table(const io::RecordingInfo& info, double duration_s) {
  Description rows = Description::array();
  for (const io::TopicInfo& topic : info.topics) {
    const bool has_rate = topic.messages > 1 && duration_s > 0.0;
    rows.push_back({{"topic", topic.name},
                    {"type", topic.type},
                    {"messages", topic.messages},
                    {"rate_Hz", has_rate ? Description(static_cast<double>(topic.messages) / duration_s)
                                         : Description()}});
  }
  return rows;
}

Description mounting(const Eigen::Isometry3d& base_T_sensor) {
  const Eigen::Vector3d p = base_T_sensor.translation();
  return {{"x_m", p.x()}, {"y_m", p.y()}, {"z_m", p.z()}, {"yaw_rad", to_pose2(base_T_sensor).yaw}};
}

}  // namespace

Result<Description> describe_log(const std::filesystem::path& file, const Session& session) {
  const Result<io::RecordingInfo> info = io::describe_recording(file);
  if (!info) return info.error();
  const double duration_s = info->first && info->last ? *info->last - *info->first : 0.0;
  Description description{{"file", file.string()}, {"kind", info->format}, {"duration_s", duration_s}};
  if (info->first) description["begins_at_s"] = info->first->seconds();
  description["topics"] = topic_table(*info, duration_s);

  io::PlayOptions options;
  options.topics = topics_of(*info);
  Progress progress("reading the log", session.quiet);
  const auto report = io::play(
      {file}, options,
      [&](const io::RecordingHeader& header) {
        description["laser_mounting"] = mounting(header.rig.base_T_laser);
        description["magnetometer_mounting"] = mounting(header.rig.base_T_magnetometer);
      },
      [&](const SensorEvent& event) {
        if (info->first && duration_s > 0.0) progress.show((stamp_of(event) - *info->first) / duration_s);
        return !interrupted();
      });
  if (!report) return report.error();
  description["problems"] = Description::array();
  for (const auto& [kind, count] : report->problems)
    description["problems"].push_back({{"count", count}, {"what", kind}});
  description["warnings"] = report->warnings;
  return description;
}

}  // namespace mstsl::app
