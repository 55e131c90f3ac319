#include "io/log/topic_check.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/ros/messages.hpp"

namespace mstsl::io {
namespace {

struct Need {
  std::string topic;
  std::string_view option;  ///< how a user names another topic
  std::vector<std::string_view> types;
  bool optional = false;
};

std::vector<Need> needs(const Topics& topics) {
  return {{topics.scan, "scan", {ros::LaserScan::kType}},
          {topics.magnetic_field, "magnetic field", {ros::MagneticField::kType}},
          {topics.odometry, "odometry", {ros::Odometry::kType}},
          {topics.transforms_static, "static transform", {ros::TFMessage::kType}, true},
          {topics.imu, "inertial", {ros::Imu::kType}, true},
          {topics.pose,
           "pose",
           {ros::Odometry::kType, ros::PoseStamped::kType, ros::PoseWithCovarianceStamped::kType}}};
}

std::string list_of(const std::vector<Channel>& channels) {
  std::vector<std::string> lines;
  for (const Channel& channel : channels)
    lines.push_back(fmt::format("{} ({}, {} messages)", channel.topic, channel.type, channel.message_count));
  std::ranges::sort(lines);
  return fmt::format("{}", fmt::join(lines, ", "));
}

Result<void> check(const std::string& log_name, const std::vector<Channel>& channels, const Need& need) {
  const auto fits = [&](const Channel& channel) {
    return std::ranges::find(need.types, channel.type) != need.types.end();
  };
  bool has_messages = false;
  bool there = false;
  for (const Channel& channel : channels) {
    if (channel.topic != need.topic) continue;
    there = true;
    has_messages |= channel.message_count > 0;
    if (!fits(channel))
      return Error(fmt::format("{}: topic {} carries {}, but the {} topic has to carry {}; name another one",
                               log_name, channel.topic, channel.type, need.option,
                               fmt::join(need.types, " or ")));
    if (channel.encoding == ros::Encoding::kOther)
      return Error(
          fmt::format("{}: topic {} is encoded neither as ROS 2 (cdr) nor as ROS 1 does; record it with ROS",
                      log_name, channel.topic));
  }
  if (has_messages || need.optional) return {};
  if (there)
    return Error(fmt::format("{}: topic {} holds no message; the log has {}", log_name, need.topic,
                             list_of(channels)));
  return Error(fmt::format("{}: there is no topic {}; name the {} topic, the log has {}", log_name,
                           need.topic, need.option, list_of(channels)));
}

}  // namespace

Result<void> check_topics(const std::string& log_name, const std::vector<Channel>& channels,
                          const Topics& topics) {
  const bool empty =
      std::ranges::all_of(channels, [](const Channel& channel) { return channel.message_count == 0; });
  if (empty) return Error(log_name + ": the log holds no messages; record it again");
  std::map<std::string, std::string_view> roles;
  for (const Need& need : needs(topics)) {
    if (need.topic.empty()) continue;
    const auto [other, is_new] = roles.try_emplace(need.topic, need.option);
    if (!is_new)
      return Error(
          fmt::format("topic {} is named as the {} topic and as the {} topic; it can only be one of them",
                      need.topic, other->second, need.option));
    if (const Result<void> checked = check(log_name, channels, need); !checked) return checked;
  }
  return {};
}

}  // namespace mstsl::io
