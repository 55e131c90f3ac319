#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/mapping/submap.hpp"

namespace mstsl {

/// How much the field of this building differs over a distance, learned from the drive itself: the mean
/// squared difference of a component between two places (twice a variogram), from readings of one stretch,
/// where a bias of the sensor cancels.
class FieldVariogram {
 public:
  /// Takes in the readings of a stretch, in the order of the drive.
  void add(std::span<const FieldAt> stretch);

  /// Whether enough was driven to say.
  bool is_known() const;
  /// Mean squared difference of a component between places `distance_m` apart (uT^2).
  double squared_difference_uT2(double distance_m) const;
  /// The same between places that have nothing to do with each other.
  double unrelated_uT2() const;

 private:
  static constexpr double kBin_m = 0.25;
  static constexpr std::size_t kBins = 24;  ///< to 6 m: several correlation lengths of any building
  struct Bin {
    double sum_uT2 = 0.0;
    double pairs = 0.0;
  };
  std::array<Bin, kBins> bins_{};
};

struct FieldEvidenceOptions {
  /// Readings within this way (m) are one piece of evidence: over about a metre errors go together
  /// (docs/joint.md).
  double correlation_m = 1.0;
  /// A reading is compared with one no farther away than this (m).
  double reach_m = 1.0;
  /// How far a match of scans may be off (m): readings are that much farther apart than they seem.
  double pose_sd_m = 0.07;
  double noise_uT = 1.0;        ///< of the difference of two readings of one place on one day
  double bias_sd_uT = 15.0;     ///< of the magnetometer, level axes, where nothing is known of it
  bool one_bias = true;         ///< the same in both stretches: they are of one drive
  double outlier_share = 0.05;  ///< of readings beside something that moved
};

/// What the field says of two stretches lying over each other.
struct FieldEvidence {
  /// Log of how much more probable the readings are if the stretches lie as assumed than if they have
  /// nothing to do with each other. Near 0 where the field tells nothing.
  double log_ratio = 0.0;
  double compared_m = 0.0;  ///< way over which there was something to compare
};

/// Compares readings of a stretch with those of an older one, frame a, the newer one's frame being at
/// `a_T_b`; the bias of the sensor (of each drive's) is estimated within.
FieldEvidence field_evidence(std::span<const FieldAt> older_a, std::span<const FieldAt> newer_b,
                             const Pose2& a_T_b, const FieldVariogram& variogram,
                             const FieldEvidenceOptions& options = {});

}  // namespace mstsl
