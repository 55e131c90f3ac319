#pragma once

#include <vector>

#include <Eigen/Core>

#include "mstsl/magnetic/field_map.hpp"

namespace mstsl {

/// Ground that no fingerprint supports, in one piece.
struct CoverageGap {
  Eigen::Vector2d inside_m = Eigen::Vector2d::Zero();  ///< the place in it that is furthest from its edge
  double area_m2 = 0.0;
};

/// What a survey covered of a map's ground, and what it left out.
struct SurveyCoverage {
  double ground_m2 = 0.0;         ///< of the cells that have a value
  double covered_m2 = 0.0;        ///< of those that a fingerprint supports
  std::vector<CoverageGap> gaps;  ///< of 1 m2 and more, the largest first
  /// Of the fingerprints: those with none near them (SurveyBiasOptions::pair_distance_m) that was taken in
  /// another direction (by 90 deg); there a bias of the magnetometer cannot be told from the field.
  double one_way_share = 0.0;
};

SurveyCoverage survey_coverage(const FieldMap& map);

}  // namespace mstsl
