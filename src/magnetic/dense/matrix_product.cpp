#include "matrix_product.hpp"

#include <algorithm>
#include <cassert>

#include "product_kernels.hpp"

namespace mstsl {
namespace {

using Eigen::Index;

// A strip of `a` that is used against a strip of `b` fits the first-level cache, all of the packed `a` the
// second.
constexpr Index kDepth = 256;
constexpr Index kRows = 192;

std::size_t round_up(std::size_t n, std::size_t step) { return (n + step - 1) / step * step; }

/// Strips of `strip` rows, column after column within a strip; the last one is filled up with zeros.
template <typename Block>
void pack(const Block& block, double scale, std::size_t strip, std::vector<double>& packed) {
  const auto rows = static_cast<std::size_t>(block.rows()), columns = static_cast<std::size_t>(block.cols());
  const auto row_stride = static_cast<std::size_t>(block.innerStride());
  const auto column_stride = static_cast<std::size_t>(block.outerStride());
  packed.resize(round_up(rows, strip) * columns);
  double* out = packed.data();
  for (std::size_t first = 0; first < rows; first += strip) {
    const std::size_t used = std::min(strip, rows - first);
    const double* in = block.data() + first * row_stride;
    for (std::size_t k = 0; k < columns; ++k, in += column_stride, out += strip) {
      if (row_stride == 1)
        for (std::size_t i = 0; i < used; ++i) out[i] = scale * in[i];
      else
        for (std::size_t i = 0; i < used; ++i) out[i] = scale * in[i * row_stride];
      std::fill(out + used, out + strip, 0.0);
    }
  }
}

}  // namespace

std::vector<const ProductKernel*> usable_product_kernels() {
  std::vector<const ProductKernel*> usable{&kPortableProduct};
#ifdef MSTSL_X86_KERNELS
  if (__builtin_cpu_supports("avx2")) usable.push_back(&kAvx2Product);
  if (__builtin_cpu_supports("avx512f")) usable.push_back(&kAvx512Product);
#endif
  return usable;
}

MatrixProduct::MatrixProduct() : kernel_(usable_product_kernels().back()) {}

void MatrixProduct::add(const Factor& a, const Factor& b, Target target, double scale) {
  assert(a.cols() == b.rows() && target.rows() == a.rows() && target.cols() == b.cols());
  for (Index k = 0; k < a.cols(); k += kDepth) {
    const Index depth = std::min(kDepth, a.cols() - k);
    const Factor b_part = b.middleRows(k, depth);
    pack(Eigen::Map<const Eigen::MatrixXd, 0, Strided>(b_part.data(), b_part.cols(), depth,
                                                       Strided(b_part.innerStride(), b_part.outerStride())),
         1.0, kernel_->columns, b_);
    for (Index i = 0; i < a.rows(); i += kRows) {
      const Index rows = std::min(kRows, a.rows() - i);
      const Factor a_part = a.block(i, k, rows, depth);
      pack(a_part, scale, kernel_->rows, a_);
      add_block(static_cast<std::size_t>(rows), static_cast<std::size_t>(b.cols()),
                static_cast<std::size_t>(depth), target.middleRows(i, rows));
    }
  }
}

/// target += packed a * packed b, piece by piece; a piece that sticks out goes through a buffer.
void MatrixProduct::add_block(std::size_t rows, std::size_t columns, std::size_t depth, Target target) {
  const std::size_t r = kernel_->rows, c = kernel_->columns;
  const auto stride = static_cast<std::size_t>(target.outerStride());
  for (std::size_t j = 0; j < columns; j += c)
    for (std::size_t i = 0; i < rows; i += r) {
      const double* a = a_.data() + i * depth;
      const double* b = b_.data() + j * depth;
      double* out = target.data() + j * stride + i;
      if (i + r <= rows && j + c <= columns) {
        kernel_->add(depth, a, b, out, stride);
        continue;
      }
      edge_.assign(r * c, 0.0);
      kernel_->add(depth, a, b, edge_.data(), r);
      for (std::size_t jj = 0; jj < std::min(c, columns - j); ++jj)
        for (std::size_t ii = 0; ii < std::min(r, rows - i); ++ii)
          out[jj * stride + ii] += edge_[jj * r + ii];
    }
}

}  // namespace mstsl
