#pragma once

#include <cstddef>
#include <deque>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/magnetic/field_sampler.hpp"

namespace mstsl {

struct FieldWitnessOptions {
  /// How far, in uT per axis, a reading at the right place may be off: what drive motors and a worn
  /// calibration add as bias, and the map's error on another day.
  double sigma_uT = 3.0;
  /// Mean squared deviation, in sigmas and per axis, up to which field and map agree. At a wrong place it is
  /// about 2 x SD^2 / sigma^2: 6 to 38 for the SD of 5 to 13 uT of real buildings.
  double agree_below = 3.0;
  /// It speaks for the last so many scans: 1.5 m of driving, more than the field's correlation length.
  std::size_t scans = 15;
};

/// Says whether the field is what the map has at a pose that is being tracked. The laser alone cannot tell a
/// changed room from another one; the field is the second witness.
class FieldWitness {
 public:
  explicit FieldWitness(const FieldWitnessOptions& options = {}) : options_(options) {}

  /// A finite reading in the base frame (uT), and where it was taken: the pose held to be right, and the
  /// place of the sensor on the base (m). Where the map has no field nothing is learned.
  void observe(const FieldSampler& field, const Eigen::Vector3d& base_field_uT, const Pose2& map_T_base,
               const Eigen::Vector2d& sensor_base_m);

  /// Whether the last scans' readings agree with the map. False, too, while there are fewer than half of
  /// them.
  bool agrees() const;

 private:
  FieldWitnessOptions options_;
  std::deque<double> deviations_;
};

}  // namespace mstsl
