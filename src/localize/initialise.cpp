#include "mstsl/localize/initialise.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "mstsl/localize/orientation.hpp"

namespace mstsl {
namespace {

/// Stage 2: the yaw of frame D in the map, by Eq. 4 from its axis in the building's body frame.
double yaw_of_aligned_frame(std::size_t heading, double building_axis_rad) {
  const double turned_rad = radians(kBuildingHeadings_deg[heading]);
  const Eigen::Vector3d d_axis(std::cos(turned_rad), std::sin(turned_rad), 0.0);
  return building_axis_rad + orientation(turn_between(d_axis, Eigen::Vector3d::UnitX()));
}

/// The covariance of the base: the place's, moved by the lever arm that the heading's error swings.
Eigen::Matrix3d pose_covariance(const Eigen::Matrix2d& place_m2, double yaw_sigma_rad,
                                const Eigen::Vector2d& lever_map_m) {
  const Eigen::Vector3d by_yaw(lever_map_m.y(), -lever_map_m.x(), 1.0);
  Eigen::Matrix3d covariance = yaw_sigma_rad * yaw_sigma_rad * by_yaw * by_yaw.transpose();
  covariance.topLeftCorner<2, 2>() += place_m2;
  return covariance;
}

}  // namespace

std::vector<FieldObservation> headed_observations(const Eigen::Vector3d& aligned_field_uT,
                                                  double building_axis_rad,
                                                  const InitialiseOptions& options) {
  std::vector<FieldObservation> observations;
  for (std::size_t heading = 0; heading < kBuildingHeadings_deg.size(); ++heading) {
    const double yaw_rad = yaw_of_aligned_frame(heading, building_axis_rad);
    const Eigen::Vector3d field = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * aligned_field_uT;
    // A small turn moves the vector at right angles to its horizontal part.
    const Eigen::Vector3d swing = options.align_sigma_rad * Eigen::Vector3d(-field.y(), field.x(), 0.0);
    const double variance = options.field_sigma_uT * options.field_sigma_uT;
    observations.push_back({field, variance * Eigen::Matrix3d::Identity() + swing * swing.transpose()});
  }
  return observations;
}

std::vector<InitialHypothesis> initialise(const FieldMatcher& field, double building_axis_rad,
                                          const AlignedReading& reading,
                                          const Eigen::Isometry3d& base_T_magnetometer,
                                          const InitialiseOptions& options) {
  const auto observations = headed_observations(reading.field_uT, building_axis_rad, options);
  const Eigen::Vector2d lever_base_m = base_T_magnetometer.translation().head<2>();
  std::vector<InitialHypothesis> hypotheses;
  for (const LocationCandidate& candidate : field.locate(observations, options.distinct)) {
    const double yaw_rad =
        yaw_of_aligned_frame(candidate.observation, building_axis_rad) + reading.aligned_yaw_rad;
    const Eigen::Vector2d lever_map_m = Eigen::Rotation2Dd(yaw_rad) * lever_base_m;
    hypotheses.push_back({Pose2::from(candidate.position_m - lever_map_m, yaw_rad),
                          pose_covariance(candidate.covariance_m2, options.align_sigma_rad, lever_map_m),
                          candidate.probability, candidate.log_density});
  }
  return hypotheses;
}

}  // namespace mstsl
