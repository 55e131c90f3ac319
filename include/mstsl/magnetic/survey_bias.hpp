#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/magnetic/fingerprint.hpp"

namespace mstsl {

struct SurveyBiasOptions {
  double pair_distance_m =
      0.3;  ///< how far apart two fingerprints may lie that are taken to see the same field
  double pair_turn_rad = 1.57;  ///< how different their headings must be at least (90 deg)
  double prior_sd_uT =
      20.0;  ///< hard iron of a badly placed magnetometer; decides where the survey cannot tell
  double soft_iron_sd = 0.05;       ///< elements of an uncalibrated robot's soft iron, likewise
  double significant_sigmas = 4.0;  ///< called significant where a component is this far from 0
  double least_soft_iron = 0.005;   ///< less changes a field of 50 uT by less than a good sensor's noise
};

/// The magnetometer's own errors in one session of a survey, in the frame of the robot's base: a constant
/// bias (hard iron), and what the robot's iron makes of the field (soft iron). What is true is soft_iron *
/// measured - base_bias_uT.
struct SessionBias {
  Eigen::Vector3d base_bias_uT = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd_uT = Eigen::Vector3d::Zero();
  bool significant = false;
  Eigen::Matrix3d soft_iron = Eigen::Matrix3d::Identity();  ///< the identity where none is significant
  double soft_iron_sd = 0.0;                                ///< largest of its elements'
  bool has_soft_iron = false;
};

struct SurveyBias {
  std::vector<SessionBias> sessions;  ///< by Fingerprint::session
  std::size_t pairs = 0;              ///< of nearby fingerprints with different headings (or sessions)
  bool any_significant() const;
};

/// Estimates each session's bias and soft iron from nearby fingerprints of passes in different directions:
/// the building's field is the same for both, the sensor's errors turn with the robot. Robust least squares
/// (Huber) over such pairs; standard deviations allow for the correlation of neighbouring pairs (clusters of
/// 2 m).
///
/// Of soft iron four numbers show: stretch and shear of the horizontal field (where lanes cross, not on lanes
/// that are only opposite) and how the horizontal field leaks into the vertical. Driving in the plane never
/// shows the vertical bias of a single session: it stays 0 with the prior's width, and is part of the map.
SurveyBias estimate_survey_bias(std::span<const Fingerprint> fingerprints,
                                const SurveyBiasOptions& options = {});

/// Undoes each session's errors, which turn with the fingerprint's heading.
void remove_bias(std::span<Fingerprint> fingerprints, const SurveyBias& bias);

}  // namespace mstsl
