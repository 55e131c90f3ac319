#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "io/mcap/writer.hpp"
#include "io/ros/decode.hpp"
#include "io/ros/schemas.hpp"
#include "recording_support.hpp"

namespace mstsl::test {

/// Writes any ROS messages, well formed or not, as an MCAP log.
class MessageFile {
 public:
  explicit MessageFile(const std::filesystem::path& path)
      : writer_(must(io::mcap::Writer::open(path, "ros2", "test"))) {}

  template <typename Message>
  MessageFile& declare(const std::string& topic) {
    using io::ros::ros2_type_name, io::ros::ros2msg_schema;
    const auto schema =
        writer_.add_schema(ros2_type_name(Message::kType), "ros2msg", ros2msg_schema(Message::kType));
    channels_[topic] = writer_.add_channel(schema, topic, "cdr", {});
    return *this;
  }

  template <typename Message>
  void write(const std::string& topic, Message message, double log_time_s) {
    write_bytes(topic, io::ros::encode_cdr(std::move(message)), log_time_s);
  }
  void write_bytes(const std::string& topic, io::ByteView bytes, double log_time_s) {
    must(writer_.write(channels_.at(topic), static_cast<std::uint64_t>(log_time_s * 1e9), bytes));
  }
  void close() { must(writer_.close()); }

 private:
  io::mcap::Writer writer_;
  std::map<std::string, std::uint16_t> channels_;
};

inline io::ros::Header ros_header(double stamp_s, std::string frame) {
  const Stamp stamp = Stamp::from_seconds(stamp_s);
  return {{stamp.ns / 1'000'000'000, static_cast<std::uint32_t>(stamp.ns % 1'000'000'000)}, std::move(frame)};
}

inline io::ros::Odometry ros_odometry(double stamp_s, double x = 0.0) {
  io::ros::Odometry odometry;
  odometry.header = ros_header(stamp_s, "odom");
  odometry.pose.pose.position.x = x;
  return odometry;
}

inline io::ros::MagneticField ros_field(double stamp_s, double bx_T = 40e-6, std::string frame = "imu_link") {
  io::ros::MagneticField field;
  field.header = ros_header(stamp_s, std::move(frame));
  field.magnetic_field.x = bx_T;
  return field;
}

inline io::ros::LaserScan ros_scan(double stamp_s, std::size_t beams = 10, std::string frame = "laser") {
  io::ros::LaserScan scan;
  scan.header = ros_header(stamp_s, std::move(frame));
  scan.angle_min = -1.0F;
  scan.angle_increment = 0.25F;
  scan.range_max = 30.0F;
  scan.ranges.assign(beams, 2.0F);
  return scan;
}

inline io::ros::TransformStamped ros_transform(std::string parent, std::string child, io::ros::Vector3 offset,
                                               io::ros::Quaternion rotation = {}) {
  return {ros_header(1.0, std::move(parent)), std::move(child), offset, rotation};
}

/// A log with the usual topics, whose sensors are mounted straight at the base, to put messages into.
class UsualLog : public MessageFile {
 public:
  explicit UsualLog(const std::filesystem::path& path) : MessageFile(path) {
    declare<io::ros::TFMessage>("/tf_static");
    declare<io::ros::LaserScan>("/scan");
    declare<io::ros::MagneticField>("/imu/mag");
    declare<io::ros::Odometry>("/odom");
    declare<io::ros::Imu>("/imu/data");
    declare<io::ros::PoseStamped>("/pose");
  }
  void put(const io::ros::LaserScan& scan, double log_time_s) { write("/scan", scan, log_time_s); }
  void put(const io::ros::MagneticField& field, double log_time_s) { write("/imu/mag", field, log_time_s); }
  void put(const io::ros::Odometry& odometry, double log_time_s) { write("/odom", odometry, log_time_s); }

  /// The mountings, and one good message of each needed kind at `stamp_s`.
  void begin(double stamp_s = 100.0) {
    io::ros::TFMessage mountings;
    mountings.transforms = {ros_transform("base_link", "laser", {}),
                            ros_transform("base_link", "imu_link", {})};
    write("/tf_static", mountings, stamp_s);
    put(ros_odometry(stamp_s), stamp_s);
    put(ros_field(stamp_s), stamp_s);
    put(ros_scan(stamp_s), stamp_s);
  }
};

}  // namespace mstsl::test
