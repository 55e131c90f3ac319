#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/io/atomic_file.hpp"

namespace mstsl::io {

/// Writes a trajectory in the format of the TUM RGB-D benchmark, which evo reads: `t x y z qx qy qz qw` a
/// line (s, m; z = 0 and only yaw here). Each line is handed to the system at once.
class TumWriter {
 public:
  static Result<TumWriter> open(const std::filesystem::path& file);
  /// Errors: a full disk, a pose that is not finite.
  Result<void> write(const PoseReading& pose);
  Result<void> close();

 private:
  explicit TumWriter(AtomicFile file) : file_(std::move(file)) {}
  AtomicFile file_;
};

/// Reads such a trajectory; lines that begin with # are comments. Of a rotation in space only the yaw is
/// kept. Errors: a line that has not eight finite numbers or no rotation, with its number.
Result<std::vector<PoseReading>> read_tum(const std::filesystem::path& file);

}  // namespace mstsl::io
