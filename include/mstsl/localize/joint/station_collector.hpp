#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/localize/joint/step.hpp"

namespace mstsl::joint {

struct StationOptions {
  /// A station ends after this much travel of the magnetometer (m): a fraction of the 0.4 m over which the
  /// fastest fields change.
  double spacing_m = 0.12;
  /// ... or after so much turning (rad): in one place only new headings tell something new, the bias.
  double turn_rad = radians(15.0);
  /// Fewer readings than this make no station, unless it moves on.
  std::size_t min_readings = 3;
};

/// Turns a stream of field readings into stations, one a place: standing still is one station however long it
/// lasts, turning in place one a heading.
class StationCollector {
 public:
  StationCollector(const Rig& rig, const StationOptions& options) : rig_(rig), options_(options) {}

  /// A reading and where the base was by odometry. Expects finite values in time order.
  void add(const FieldReading& reading, const Pose2& track_T_base);

  /// The stations that ended since the last call, seen from `track_T_base`.
  std::vector<Station> take(const Pose2& track_T_base);

  /// The way on is not known to begin where the last station was.
  void interrupt();

 private:
  struct Open {
    TimedPose first;
    Pose2 last;
    Stamp last_stamp;
    Eigen::Vector3d sum_uT = Eigen::Vector3d::Zero();  ///< in the axes of the base at the first reading
    Eigen::Vector3d squares_uT2 = Eigen::Vector3d::Zero();
    std::size_t readings = 0;
  };
  struct Ended {
    Pose2 track_T_base;
    Station station;
  };
  Eigen::Vector2d sensor_at(const Pose2& track_T_base) const;
  bool begins_new(const Pose2& track_T_base) const;
  void close();

  Rig rig_;
  StationOptions options_;
  std::optional<Open> open_;
  std::vector<Ended> ended_;
  std::optional<Eigen::Vector2d> last_place_m_;
};

}  // namespace mstsl::joint
