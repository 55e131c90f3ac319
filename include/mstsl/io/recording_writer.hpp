#pragma once

#include <filesystem>
#include <memory>

#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/io/recording.hpp"

namespace mstsl::io {

/// Writes sensor events as a ROS 2 MCAP log: LaserScan, MagneticField (in tesla), Odometry, Imu, TFMessage on
/// /tf_static, and poses as PoseStamped. The log appears under its final name only when closed; a writer that
/// is dropped unclosed leaves nothing behind.
class RecordingWriter {
 public:
  static Result<RecordingWriter> open(const std::filesystem::path& file, const Rig& rig,
                                      const Topics& topics);
  RecordingWriter(RecordingWriter&&) noexcept;
  RecordingWriter& operator=(RecordingWriter&&) noexcept;
  ~RecordingWriter();

  /// Events go to the topic of their kind, and nowhere if that has no name. An OdometryRestart may only come
  /// first: a log holds one run of odometry. Errors: a full disk, a stamp that ROS cannot hold (before 1970
  /// or after 2038), a restart in the middle.
  Result<void> write(const SensorEvent& event);
  Result<void> close();

 private:
  struct State;
  explicit RecordingWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace mstsl::io
