#pragma once

#include <array>

#include <Eigen/Core>

namespace mstsl {

/// The paper's D in G: the angle phi in [0, pi] between two axes and the unit axis a that the turn from D to
/// G goes about (zero where the two are parallel and any axis would do).
struct AxisAngle {
  double phi_rad = 0.0;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
};

/// phi = arccos(D . G / (|D| |G|)), a = (D x G) / |D x G| (paper section III-A.3 b). Expects two vectors that
/// are not zero.
AxisAngle turn_between(const Eigen::Vector3d& d_axis, const Eigen::Vector3d& g_axis);

/// Eq. 4: the robot's heading theta in the global frame, for a robot that stands parallel or square to the
/// building. Of the paper's four cases the nearest is taken, since measured angles are never exactly 0, pi/2
/// or pi:
///   0 if phi = 0;  -pi if phi = pi;  -pi/2 if phi = pi/2 and a points up;  pi/2 if phi = pi/2 and a points
///   down.
/// (a = D x G points up where G lies counter-clockwise of D, that is where D itself is turned clockwise.)
double orientation(const AxisAngle& d_to_g);

/// The four headings that a robot parallel or square to the building can have, relative to the building's
/// axis.
inline constexpr std::array<double, 4> kBuildingHeadings_deg{0.0, 180.0, 90.0, -90.0};

}  // namespace mstsl
