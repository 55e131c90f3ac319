#pragma once

#include <cstddef>

/// The innermost loop of a matrix product. This header is compiled several times, for several instruction
/// sets; it includes nothing that could leave an inline function behind for processors that lack them.
namespace mstsl {

/// c (rows x columns, its columns c_stride apart) += a * b, where a is packed as rows x depth, b as depth x
/// columns with the columns next to each other.
using ProductKernelFunction = void (*)(std::size_t depth, const double* a, const double* b, double* c,
                                       std::size_t c_stride);

struct ProductKernel {
  const char* name;
  std::size_t rows, columns;  ///< of the piece that stays in registers
  ProductKernelFunction add;
};

namespace {

/// kVectors registers of kLanes doubles for each of kColumns columns.
template <std::size_t kLanes, std::size_t kVectors, std::size_t kColumns>
void add_product_of_packed(std::size_t depth, const double* a, const double* b, double* c,
                           std::size_t c_stride) {
  using Vector [[gnu::vector_size(kLanes * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] =
      double;
  Vector sums[kColumns][kVectors] = {};
  for (std::size_t k = 0; k < depth; ++k) {
    Vector column[kVectors];
#pragma GCC unroll 8
    for (std::size_t v = 0; v < kVectors; ++v) column[v] = *reinterpret_cast<const Vector*>(a + v * kLanes);
#pragma GCC unroll 16
    for (std::size_t j = 0; j < kColumns; ++j)
#pragma GCC unroll 8
      for (std::size_t v = 0; v < kVectors; ++v) sums[j][v] += column[v] * b[j];
    a += kVectors * kLanes;
    b += kColumns;
  }
#pragma GCC unroll 16
  for (std::size_t j = 0; j < kColumns; ++j)
#pragma GCC unroll 8
    for (std::size_t v = 0; v < kVectors; ++v)
      *reinterpret_cast<Vector*>(c + j * c_stride + v * kLanes) += sums[j][v];
}

template <std::size_t kLanes, std::size_t kVectors, std::size_t kColumns>
constexpr ProductKernel product_kernel(const char* name) {
  return {name, kLanes * kVectors, kColumns, &add_product_of_packed<kLanes, kVectors, kColumns>};
}

}  // namespace
}  // namespace mstsl
