#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mstsl/magnetic/fingerprint.hpp"

namespace mstsl {

struct OutlierOptions {
  double neighbourhood_m = 0.3;  ///< the field bends little over it (correlation 0.4-3 m in real buildings)
  double deviations = 8.0;  ///< allowed distance from the neighbours' median, in robust standard deviations
  double least_uT = 10.0;   ///< never smaller than this: steel close by makes steps of a few uT in earnest
};

/// Indices of fingerprints whose field cannot belong to their place (a magnet driven past, a broken message):
/// further from the median of their neighbours than anything else there (Hampel's test, per component).
/// Increasing order.
std::vector<std::size_t> find_outliers(std::span<const Fingerprint> fingerprints,
                                       const OutlierOptions& options = {});

}  // namespace mstsl
