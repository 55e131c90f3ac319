#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/stamp.hpp"

namespace mstsl {

enum class LocalizationStatus { kSearching, kLocalized, kLost };

/// "searching", "localized" or "lost", as the estimates file has it.
std::string_view to_string(LocalizationStatus status);

/// One place where the robot may be; the weights of all hypotheses and of "none of these" sum to 1.
struct Hypothesis {
  Pose2 map_T_base;
  double weight = 0.0;
};

/// What a localizer knows after the events so far.
struct Estimate {
  Stamp stamp;
  double travelled_m = 0.0;
  LocalizationStatus status = LocalizationStatus::kSearching;
  std::optional<Pose2> map_T_base;                       ///< nothing unless localized
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y (m) and yaw (rad), map frame
  double probability = 0.0;                              ///< that the pose is right: within 0.5 m and 10 deg
  std::vector<Hypothesis> hypotheses;                    ///< best first
  std::optional<Eigen::Vector3d> bias_uT;  ///< of the magnetometer, sensor frame, where estimated
};

}  // namespace mstsl
