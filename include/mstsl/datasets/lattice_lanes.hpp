#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mstsl/magnetic/fingerprint.hpp"

namespace mstsl::datasets {

/// How points surveyed on a lattice parallel to the map's axes are joined to lanes.
struct LatticeOptions {
  double same_line_m = 0.01;      ///< points whose other coordinate differs by less lie on one line
  double longest_gap_m = 0.85;    ///< neighbours on a line farther apart have something between them
  std::size_t fewest_points = 8;  ///< shorter pieces run across a corridor, not along it
};

/// The straight lanes along x and along y that the points lie on, each in order of its coordinate. A point
/// where two lanes cross is in both; one on no lane of enough points is in none.
std::vector<std::vector<Fingerprint>> lattice_lanes(std::span<const Fingerprint> points,
                                                    const LatticeOptions& options = {});

}  // namespace mstsl::datasets
