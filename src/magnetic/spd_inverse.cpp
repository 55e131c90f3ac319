#include "spd_inverse.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace mstsl {
namespace {

using Eigen::Index;
using Eigen::Lower;
using Eigen::MatrixXd;

constexpr Index kBlock = 48;

/// Lower triangular matrix -> its inverse in place; the upper triangle is not touched.
void invert_lower(Eigen::Ref<MatrixXd> l) {
  const Index n = l.rows();
  if (n <= kBlock) {
    MatrixXd inverse = MatrixXd::Identity(n, n);
    l.triangularView<Lower>().solveInPlace(inverse);
    l.triangularView<Lower>() = inverse;
    return;
  }
  const Index half = n / 2;
  invert_lower(l.topLeftCorner(half, half));
  invert_lower(l.bottomRightCorner(n - half, n - half));
  const MatrixXd product =
      l.bottomLeftCorner(n - half, half) * l.topLeftCorner(half, half).triangularView<Lower>();
  l.bottomLeftCorner(n - half, half).noalias() =
      -(l.bottomRightCorner(n - half, n - half).triangularView<Lower>() * product);
}

}  // namespace

std::optional<MatrixXd> spd_inverse(const MatrixXd& matrix) {
  Eigen::LLT<MatrixXd> factor(matrix);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Index n = matrix.rows();
  MatrixXd l = factor.matrixL();
  invert_lower(l);
  // A^-1 = L^-T L^-1, lower triangle column block by column block: block (i, j) only needs rows from i down.
  MatrixXd inverse(n, n);
  for (Index i = 0; i < n; i += kBlock) {
    const Index rows = std::min(kBlock, n - i);
    inverse.block(i, 0, rows, i + rows).noalias() =
        l.block(i, i, n - i, rows).transpose() * l.block(i, 0, n - i, i + rows);
  }
  inverse.triangularView<Eigen::StrictlyUpper>() = inverse.transpose();
  return inverse;
}

}  // namespace mstsl
