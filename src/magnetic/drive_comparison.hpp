#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mstsl/magnetic/field_update.hpp"

namespace mstsl {

/// A drive with its bias taken out, held against a map.
struct ComparedDrive {
  std::vector<Fingerprint> fingerprints;
  std::vector<std::uint8_t> changed;  ///< 1 where the fingerprint lies in a changed stretch
  DriveComparison comparison;
};

ComparedDrive compare_drive(const FieldMap& map, std::span<const Fingerprint> drive,
                            const FieldUpdateOptions& options);

}  // namespace mstsl
