#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mstsl/magnetic/fingerprint.hpp"

namespace mstsl {

struct LaneOptions {
  double max_gap_m = 0.5;  ///< a longer step between two fingerprints starts a new lane
  double max_turn_rad =
      0.79;  ///< so does a turn of the direction of travel by this (45 deg) from the lane's start
  double max_length_m = 10.0;  ///< so that one endless pass still makes several lanes
};

/// A straight piece of a survey's drive: fingerprints first .. last - 1.
struct Lane {
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t size() const { return last - first; }
};

/// Cuts fingerprints, in the order of the drive, into lanes; every fingerprint is in exactly one.
std::vector<Lane> split_lanes(std::span<const Fingerprint> fingerprints, const LaneOptions& options = {});

}  // namespace mstsl
