#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "mstsl/grid/geometry.hpp"

/// The names in a field map's file, shared by its writer and its reader.
namespace mstsl::io {

inline constexpr std::string_view kHyperparameter = "hyperparameter_";

struct FieldComponent {
  const char* mean;
  const char* variance;
  const char* direction;
};
inline constexpr std::array<FieldComponent, 3> kFieldComponents{{{"bx", "bx_variance", "along map x"},
                                                                 {"by", "by_variance", "along map y"},
                                                                 {"bz", "bz_variance", "upwards"}}};

/// Fingerprints are written as columns whose names begin so, over a dimension of their own.
struct FingerprintTable {
  const char* dimension;
  const char* prefix;
};
inline constexpr FingerprintTable kCurrent{"fingerprint", "fp_"},
    kReplaced{"replaced_fingerprint", "replaced_fp_"};

/// Which drives a map is made of: columns over this dimension, their names in a global attribute.
inline constexpr const char* kDrive = "drive";
inline constexpr const char* kDriveNames = "drives";
inline constexpr const char* kStampUnit = "nanoseconds since 1970-01-01 00:00:00";

/// Cell centres along one axis: in the map frame for a grid that is not turned, else in the grid's frame.
std::vector<double> cell_centers(const GridGeometry& geometry, int count, double origin_m);

}  // namespace mstsl::io
