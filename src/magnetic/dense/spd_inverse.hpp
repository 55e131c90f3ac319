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
  /// The same for a matrix that is not needed any more, without a copy of it; what it holds then is of no
  /// use.
  const Eigen::MatrixXd* invert(Eigen::MatrixXd&& matrix);

 private:
  const Eigen::MatrixXd* invert_held();
  bool invert_factor(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> a);

  MatrixProduct product_;
  Eigen::MatrixXd factor_, scratch_, inverse_;
};

}  // namespace mstsl
