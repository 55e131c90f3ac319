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
  double significant_sigmas = 4.0;  ///< a bias is called significant where a component is this far from 0
};

/// The constant magnetometer bias (hard iron) of one session of a survey, in the frame of the robot's base.
struct SessionBias {
  Eigen::Vector3d base_bias_uT = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd_uT = Eigen::Vector3d::Zero();
  bool significant = false;
};

struct SurveyBias {
  std::vector<SessionBias> sessions;  ///< by Fingerprint::session
  std::size_t pairs = 0;              ///< of nearby fingerprints with different headings (or sessions)
  bool any_significant() const;
};

/// Estimates each session's bias from nearby fingerprints of opposite passes: the building's field is the
/// same for both, a bias turns with the robot. Robust least squares (Huber) over such pairs; standard
/// deviations allow for the correlation of neighbouring pairs (clusters of 2 m). Driving in the plane never
/// shows the vertical bias of a single session: it stays 0 with the prior's width, and is part of the map.
SurveyBias estimate_survey_bias(std::span<const Fingerprint> fingerprints,
                                const SurveyBiasOptions& options = {});

/// Takes each session's bias, turned by the fingerprint's heading, from its field.
void remove_bias(std::span<Fingerprint> fingerprints, const SurveyBias& bias);

}  // namespace mstsl
