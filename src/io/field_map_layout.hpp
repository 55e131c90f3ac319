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
  const char* fingerprint;
  const char* direction;
};
inline constexpr std::array<FieldComponent, 3> kFieldComponents{
    {{"bx", "bx_variance", "fp_bx", "along map x"},
     {"by", "by_variance", "fp_by", "along map y"},
     {"bz", "bz_variance", "fp_bz", "upwards"}}};

/// Cell centres along one axis: in the map frame for a grid that is not turned, else in the grid's frame.
std::vector<double> cell_centers(const GridGeometry& geometry, int count, double origin_m);

}  // namespace mstsl::io
