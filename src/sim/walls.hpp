#pragma once

#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::sim {

/// A part of a wall that is set back from the free side (depth > 0) or stands out into it (depth < 0).
struct Relief {
  double at_m = 0.0;  ///< its middle, from the wall's start
  double width_m = 0.0;
  double depth_m = 0.0;
  bool door = false;  ///< a framed door closes it
};

/// A straight wall from a to b with the free side on its left.
struct Wall {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  std::vector<Relief> reliefs;  ///< in order, not overlapping

  double length_m() const { return (b - a).norm(); }
  /// A frame on the wall: x along it, y into the free side.
  Pose2 frame_at(double along_m) const;
};

/// The corners of walls that follow one another.
std::vector<Eigen::Vector2d> corners(const std::vector<Wall>& walls);

/// The walls turned by 180 deg about the map's origin, each relief displaced a little: a copy as built.
std::vector<Wall> opposite(const std::vector<Wall>& walls, double asymmetry_m, Random& random);

/// How steel is spread along walls.
struct Furnishing {
  double height_m = 2.8;  ///< of the ceiling
  double column_spacing_m = 6.0;
  bool steel_columns = false;     ///< rolled steel rather than reinforced concrete
  double radiators = 0.0;         ///< share of 2.4 m stretches with a radiator
  double hidden_spacing_m = 2.2;  ///< places for furniture behind the wall; 0 for none
};

/// Columns, door frames, radiators and what stands behind one wall.
void furnish(WorldPlan& plan, const Wall& wall, const Furnishing& furnishing, Random& random);

}  // namespace mstsl::sim
