#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/magnetic/matcher.hpp"

namespace mstsl {

/// Places of a map, stored bin by bin of a square raster, so that what lies near a point is found at once.
struct BinnedPlaces {
  struct Bin {
    std::size_t first, last;        ///< places first .. last - 1
    Eigen::Vector2d low_m, high_m;  ///< what they span
  };
  std::vector<Eigen::Vector2d> positions_m;
  std::vector<Bin> bins;

  /// Sorts the points into bins; `order` receives for each place the index of its point.
  static BinnedPlaces make(std::span<const Eigen::Vector2d> points_m, std::vector<std::size_t>& order);
};

/// How well each place explains what was measured.
struct PlaceScores {
  std::vector<float> log_density;  ///< of the best observation; -infinity where it is out of the question
  std::vector<std::uint16_t> observation;  ///< which that is
  std::vector<float> mass;  ///< share of the posterior, over all observations, up to one common factor
};

/// Picks distinct places by non-maximum suppression, best first.
std::vector<LocationCandidate> select_distinct(const BinnedPlaces& places, const PlaceScores& scores,
                                               const DistinctOptions& options);

}  // namespace mstsl
