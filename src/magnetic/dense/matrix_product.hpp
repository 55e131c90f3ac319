#pragma once

#include <vector>

#include <Eigen/Core>

#include "product_kernel.hpp"

namespace mstsl {

/// Products of dense matrices at the speed of the widest vectors that the processor has, whatever instruction
/// set the library was compiled for; Eigen's own are bound to that. The order of summation is fixed: the same
/// processor gives the same bits.
///
/// An object keeps its packed pieces between calls; one thread at a time may use it.
class MatrixProduct {
 public:
  using Strided = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
  using Factor = Eigen::Ref<const Eigen::MatrixXd, 0, Strided>;         ///< binds to transposed views too
  using Target = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;  ///< must not overlap the factors

  MatrixProduct();  ///< the fastest kernel that the processor runs
  explicit MatrixProduct(const ProductKernel& kernel) : kernel_(&kernel) {}

  /// target += scale * a * b
  void add(const Factor& a, const Factor& b, Target target, double scale = 1.0);

 private:
  void add_block(std::size_t rows, std::size_t columns, std::size_t depth, Target target);

  const ProductKernel* kernel_;
  std::vector<double> a_, b_, edge_;
};

}  // namespace mstsl
