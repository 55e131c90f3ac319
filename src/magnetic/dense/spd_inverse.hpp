#pragma once

#include <Eigen/Core>

#include "matrix_product.hpp"

namespace mstsl {

/// Inverts symmetric positive definite matrices, with all work in matrix products. Keeps its memory between
/// calls; one thread at a time may use it.
class SpdInverse {
 public:
  explicit SpdInverse(MatrixProduct product = MatrixProduct()) : product_(std::move(product)) {}

  /// Reads the lower triangle. The inverse, full and symmetric, valid until the next call; null where the
  /// matrix is not positive definite.
  const Eigen::MatrixXd* operator()(const Eigen::MatrixXd& matrix);

 private:
  bool invert_factor(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> a);

  MatrixProduct product_;
  Eigen::MatrixXd factor_, scratch_, inverse_;
};

}  // namespace mstsl
