#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>

#include "mstsl/core/sensor_data.hpp"
#include "mstsl/io/recording.hpp"

#include "io/log/message_log.hpp"
#include "io/ros/messages.hpp"

namespace mstsl::io {

/// What is known of a log's sensors before its events are made.
struct SensorSetup {
  std::string scan_frame, magnetic_frame, imu_frame;  ///< empty: no message of the kind
  double microtesla_per_unit = 1e6;                   ///< of the magnetic readings as they lie in the log
  Eigen::Quaterniond magnetometer_q_imu = Eigen::Quaterniond::Identity();
};

/// Makes sensor events of messages. A message that cannot be one is counted in the report, by what is wrong
/// with it.
class RosEvents {
 public:
  RosEvents(const Topics& topics, SensorSetup setup, PlayReport& report)
      : topics_(topics), setup_(std::move(setup)), report_(&report) {}

  std::optional<SensorEvent> make(const RawMessage& message);

 private:
  std::optional<SensorEvent> scan(const RawMessage& message);
  std::optional<SensorEvent> field(const RawMessage& message);
  std::optional<SensorEvent> odometry(const RawMessage& message);
  std::optional<SensorEvent> imu(const RawMessage& message);
  std::optional<SensorEvent> pose(const RawMessage& message);

  template <typename Message>
  std::optional<Message> decode(const RawMessage& message);
  Stamp stamp(const ros::Header& header, const RawMessage& message);
  std::optional<Pose2> planar(const ros::Pose& pose, std::string_view kind);
  std::nullopt_t drop(std::string_view kind, std::string_view why);

  Topics topics_;
  SensorSetup setup_;
  PlayReport* report_;
};

/// The transform in a TF message's entry; nothing when it holds numbers that make no rigid motion.
std::optional<Eigen::Isometry3d> to_isometry(const ros::Vector3& translation,
                                             const ros::Quaternion& rotation);

}  // namespace mstsl::io
