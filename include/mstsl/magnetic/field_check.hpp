#pragma once

#include <cstddef>
#include <span>

#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/magnetic/fingerprint.hpp"
#include "mstsl/magnetic/variance_calibration.hpp"

namespace mstsl {

/// How well a map foretold what another drive measured.
struct FieldCheck {
  HeldOutScore score;             ///< by the map's own variance
  std::size_t without_value = 0;  ///< fingerprints where the map says nothing
  /// Measured minus foretold: what all of the drive shares is its own bias, not the map's error.
  Eigen::Array3d mean_error_uT = Eigen::Array3d::Zero();
};

/// Expects finite fingerprints that the map was not made from.
FieldCheck check_field_map(const FieldMap& map, std::span<const Fingerprint> fingerprints);

}  // namespace mstsl
