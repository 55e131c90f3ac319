#pragma once

#include <vector>

#include <Eigen/Core>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/localize/align.hpp"
#include "mstsl/magnetic/matcher.hpp"

namespace mstsl {

struct InitialiseOptions {
  /// K and how far apart locations must be.
  DistinctOptions distinct;
  /// How far, in uT per axis, a reading may be off from the map beyond the map's own variance: sensor noise,
  /// what calibration left of the bias, and change of the place. Two passes of the same real corridors
  /// (cea-corridor) agree to 1.1-1.3 uT rms where they cross within 0.2 m, noise and bias of both included.
  double field_sigma_uT = 0.8;
  /// Error of the alignment with the building: the paper's Table I has a mean deviation of 1.2 deg. Turns the
  /// horizontal field, so it weighs where that is strong.
  double align_sigma_rad = radians(1.2);
};

/// One x_i^k: where the base may have been when the reading was taken.
struct InitialHypothesis {
  Pose2 map_T_base;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of x, y (m), yaw (rad), map frame
  double probability = 0.0;  ///< Eq. 2 with a uniform prior; what is missing to 1 lies elsewhere
  double log_density = 0.0;
};

/// The aligned reading turned into the map frame for each of the four headings that a robot standing parallel
/// or square to the building can have (kBuildingHeadings_deg), with its covariance. The paper compares the
/// angles of the horizontal field against the body's x axis, measured (alpha) and mapped (gamma): D is the
/// right frame where they are equal. Comparing the turned vectors does the same for both at once, quadrant
/// included.
std::vector<FieldObservation> headed_observations(const Eigen::Vector3d& aligned_field_uT,
                                                  double building_axis_rad, const InitialiseOptions& options);

/// The paper's two stages (section III-A.3): location by matching the field (Eq. 2), heading by Eq. 4. The K
/// most probable distinct places, best first, as poses of base_link: the magnetometer's lever arm is taken
/// off.
std::vector<InitialHypothesis> initialise(const FieldMatcher& field, double building_axis_rad,
                                          const AlignedReading& reading,
                                          const Eigen::Isometry3d& base_T_magnetometer,
                                          const InitialiseOptions& options);

}  // namespace mstsl
