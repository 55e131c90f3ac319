#include "spd_inverse.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace mstsl {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Block = Eigen::Ref<MatrixXd, 0, Eigen::OuterStride<>>;

constexpr Index kSmallest = 48;  ///< below it, there is nothing to gain from products
constexpr Index kPanel = 96;     ///< width of the panels in which triangles are taken

/// work(first, width) for each panel of n columns or rows.
template <typename Work>
void by_panels(Index n, const Work& work) {
  for (Index i = 0; i < n; i += kPanel) work(i, std::min(kPanel, n - i));
}

bool invert_small_factor(Block a) {
  const Eigen::LLT<MatrixXd> factor(a);
  if (factor.info() != Eigen::Success) return false;
  a = factor.matrixL().solve(MatrixXd::Identity(a.rows(), a.rows()));
  return true;
}

}  // namespace

/// The lower triangle of a -> L^-1 with a = L L^T, and zeros above it; by halves:
/// L21 = A21 L11^-T, L22 L22^T = A22 - L21 L21^T, and L^-1 has -L22^-1 L21 L11^-1 below its diagonal.
bool SpdInverse::invert_factor(Block a) {
  const Index n = a.rows(), n1 = n / 2, n2 = n - n1;
  if (n <= kSmallest) return invert_small_factor(a);
  Block w11 = a.topLeftCorner(n1, n1), a21 = a.bottomLeftCorner(n2, n1), a22 = a.bottomRightCorner(n2, n2);
  if (!invert_factor(w11)) return false;
  Block scratch = scratch_.topLeftCorner(n2, n1);

  scratch.setZero();
  by_panels(n1, [&](Index j, Index width) {
    product_.add(a21.leftCols(j + width), w11.block(j, 0, width, j + width).transpose(),
                 scratch.middleCols(j, width));
  });
  a21 = scratch;
  by_panels(n2, [&](Index j, Index width) {
    product_.add(a21.bottomRows(n2 - j), a21.middleRows(j, width).transpose(), a22.block(j, j, n2 - j, width),
                 -1.0);
  });
  if (!invert_factor(a22)) return false;

  scratch.setZero();
  by_panels(n1, [&](Index j, Index width) {
    product_.add(a21.rightCols(n1 - j), w11.block(j, j, n1 - j, width), scratch.middleCols(j, width));
  });
  a21.setZero();
  by_panels(n2, [&](Index i, Index width) {
    product_.add(a22.block(i, 0, width, i + width), scratch.topRows(i + width), a21.middleRows(i, width),
                 -1.0);
  });
  a.topRightCorner(n1, n2).setZero();
  return true;
}

const MatrixXd* SpdInverse::operator()(const MatrixXd& matrix) {
  factor_ = matrix;
  return invert_held();
}

const MatrixXd* SpdInverse::invert(MatrixXd&& matrix) {
  factor_.swap(matrix);
  return invert_held();
}

const MatrixXd* SpdInverse::invert_held() {
  const Index n = factor_.rows(), half = (n + 1) / 2;
  if (scratch_.rows() < half) scratch_.resize(half, half);
  if (!invert_factor(factor_)) return nullptr;
  // A^-1 = L^-T L^-1: rows of its lower triangle only need rows of L^-1 from there down.
  inverse_.setZero(n, n);
  by_panels(n, [&](Index i, Index width) {
    product_.add(factor_.block(i, i, n - i, width).transpose(), factor_.block(i, 0, n - i, i + width),
                 inverse_.block(i, 0, width, i + width));
  });
  inverse_.triangularView<Eigen::StrictlyUpper>() = inverse_.transpose();
  return &inverse_;
}

}  // namespace mstsl
