#include "mstsl/io/recording_writer.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "io/mcap/writer.hpp"
#include "io/ros/decode.hpp"
#include "io/ros/schemas.hpp"

namespace mstsl::io {
namespace {

constexpr double kTeslaPerMicrotesla = 1e-6;

/// What ROS 2's tools need to offer /tf_static again to nodes that come later: reliable, transient local,
/// keep last 1.
constexpr const char* kLatchedQos =
    "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n"
    "  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  liveliness: 1\n  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  avoid_ros_namespace_conventions: false";

ros::Header header(Stamp stamp, const char* frame) {
  return {{stamp.ns / 1'000'000'000, static_cast<std::uint32_t>(stamp.ns % 1'000'000'000)}, frame};
}

ros::Vector3 to_ros(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

ros::Quaternion to_ros(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

ros::Pose to_ros(const Pose2& pose) {
  return {{pose.x, pose.y, 0.0}, {0.0, 0.0, std::sin(0.5 * pose.yaw), std::cos(0.5 * pose.yaw)}};
}

ros::TransformStamped mounting(Stamp stamp, const char* child, const Eigen::Isometry3d& base_T_child) {
  return {header(stamp, "base_link"), child, to_ros(Eigen::Vector3d(base_T_child.translation())),
          to_ros(Eigen::Quaterniond(base_T_child.rotation()))};
}

ros::LaserScan to_ros(const LaserScan& scan) {
  const auto beams = static_cast<double>(scan.ranges_m.size());
  const double last_angle_rad = scan.angle_min_rad + (beams > 0 ? beams - 1 : 0) * scan.angle_increment_rad;
  return {.header = header(scan.stamp, "laser"),
          .angle_min = static_cast<float>(scan.angle_min_rad),
          .angle_max = static_cast<float>(last_angle_rad),
          .angle_increment = static_cast<float>(scan.angle_increment_rad),
          .time_increment = static_cast<float>(scan.time_increment_s),
          .scan_time = static_cast<float>(beams * scan.time_increment_s),
          .range_min = static_cast<float>(scan.range_min_m),
          .range_max = static_cast<float>(scan.range_max_m),
          .ranges = scan.ranges_m,
          .intensities = {}};
}

}  // namespace

/// Topics become channels when the file is opened, those that stay silent too: a reader sees what was
/// recorded.
struct RecordingWriter::State {
  mcap::Writer file;
  std::string name;
  Rig rig;
  Topics topics;
  std::map<std::string, std::uint16_t> channels{};
  bool has_mountings = false;

  template <typename Message>
  void add_channel(const std::string& topic, std::map<std::string, std::string> metadata = {}) {
    if (topic.empty()) return;
    const std::uint16_t schema =
        file.add_schema(ros::ros2_type_name(Message::kType), "ros2msg", ros::ros2msg_schema(Message::kType));
    channels[topic] = file.add_channel(schema, topic, "cdr", std::move(metadata));
  }

  template <typename Message>
  Result<void> put(const std::string& topic, Stamp stamp, Message message) {
    if (topic.empty()) return {};
    return file.write(channels.at(topic), static_cast<std::uint64_t>(stamp.ns),
                      ros::encode_cdr(std::move(message)));
  }

  Result<void> put_mountings(Stamp stamp) {
    has_mountings = true;
    return put(topics.transforms_static, stamp,
               ros::TFMessage{{mounting(stamp, "laser", rig.base_T_laser),
                               mounting(stamp, "imu_link", rig.base_T_magnetometer)}});
  }

  Result<void> put(const OdometryReading& reading) {
    return put(topics.odometry, reading.stamp,
               ros::Odometry{header(reading.stamp, "odom"), "base_link", {to_ros(reading.odom_T_base)}, {}});
  }
  Result<void> put(const LaserScan& scan) { return put(topics.scan, scan.stamp, to_ros(scan)); }
  Result<void> put(const FieldReading& reading) {
    const Eigen::Vector3d field_T = reading.sensor_field_uT * kTeslaPerMicrotesla;
    return put(topics.magnetic_field, reading.stamp,
               ros::MagneticField{header(reading.stamp, "imu_link"), to_ros(field_T)});
  }
  Result<void> put(const ImuReading& reading) {
    ros::Imu imu;
    imu.header = header(reading.stamp, "imu_link");
    imu.angular_velocity = to_ros(reading.angular_velocity_rad_s);
    if (reading.world_q_sensor)
      imu.orientation = to_ros(*reading.world_q_sensor);
    else
      imu.orientation_covariance.front() = -1.0;
    imu.linear_acceleration_covariance.front() = -1.0;
    return put(topics.imu, reading.stamp, std::move(imu));
  }
  Result<void> put(const PoseReading& reading) {
    return put(topics.pose, reading.stamp,
               ros::PoseStamped{header(reading.stamp, "map"), to_ros(reading.map_T_base)});
  }
  Result<void> put(const OdometryRestart&) {
    return Error(name + ": a log holds one run of odometry; begin another file where it restarts");
  }
};

RecordingWriter::RecordingWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;
RecordingWriter& RecordingWriter::operator=(RecordingWriter&&) noexcept = default;
RecordingWriter::~RecordingWriter() = default;

Result<RecordingWriter> RecordingWriter::open(const std::filesystem::path& file, const Rig& rig,
                                              const Topics& topics) {
  Result<mcap::Writer> writer = mcap::Writer::open(file, "ros2", "mstsl " MSTSL_VERSION);
  if (!writer) return writer.error();
  auto state = std::make_unique<State>(State{std::move(writer).value(), file.string(), rig, topics});
  state->add_channel<ros::TFMessage>(topics.transforms_static, {{"offered_qos_profiles", kLatchedQos}});
  state->add_channel<ros::LaserScan>(topics.scan);
  state->add_channel<ros::MagneticField>(topics.magnetic_field);
  state->add_channel<ros::Odometry>(topics.odometry);
  state->add_channel<ros::Imu>(topics.imu);
  state->add_channel<ros::PoseStamped>(topics.pose);
  return RecordingWriter(std::move(state));
}

Result<void> RecordingWriter::write(const SensorEvent& event) {
  const Stamp stamp = stamp_of(event);
  constexpr std::int64_t kEnd_s = std::numeric_limits<std::int32_t>::max();
  if (stamp.ns < 0 || stamp.ns / 1'000'000'000 > kEnd_s)
    return Error(fmt::format("{}: the stamp {} s cannot be written; ROS stamps lie between 1970 and 2038",
                             state_->name, stamp.seconds()));
  if (std::holds_alternative<OdometryRestart>(event) && !state_->has_mountings) return {};
  if (!state_->has_mountings) {
    if (const Result<void> done = state_->put_mountings(stamp); !done) return done;
  }
  return std::visit([this](const auto& reading) { return state_->put(reading); }, event);
}

Result<void> RecordingWriter::close() {
  if (!state_->has_mountings) {
    if (const Result<void> done = state_->put_mountings({}); !done) return done;
  }
  return state_->file.close();
}

}  // namespace mstsl::io
