#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "turns.hpp"

namespace mstsl {

/// What the horizontal and vertical field over turns on the spot say of the robot's iron, base frame:
/// shape * (horizontal - centre) lies on a circle around 0 for each turn, and vertical - lean . that is
/// constant.
struct TurnEllipse {
  Eigen::Vector2d centre_uT = Eigen::Vector2d::Zero();
  Eigen::Matrix2d shape = Eigen::Matrix2d::Identity();  ///< symmetric, determinant 1
  Eigen::Vector2d lean = Eigen::Vector2d::Zero();

  Eigen::Vector2d corrected(const Eigen::Vector3d& base_field_uT) const {
    return shape * (base_field_uT.head<2>() - centre_uT);
  }
};

/// Least squares over all turns (robust against single headings). Nothing where the samples lie on no
/// ellipse.
std::optional<TurnEllipse> fit_ellipse(std::span<const TurnSample> samples, std::size_t turns);

/// Root mean square change of the horizontal strength within turns, in uT.
double strength_change_uT(std::span<const TurnSample> samples, std::size_t turns, const TurnEllipse& ellipse);

/// Mean horizontal strength of each turn, in uT.
Eigen::VectorXd strengths_uT(std::span<const TurnSample> samples, std::size_t turns,
                             const TurnEllipse& ellipse);

}  // namespace mstsl
