#include <algorithm>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

#include "dense/product_kernels.hpp"
#include "dense/spd_inverse.hpp"

namespace mstsl {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd random_matrix(Index rows, Index columns, Random& random) {
  return MatrixXd::NullaryExpr(rows, columns, [&](Index, Index) { return random.normal(); });
}

struct Shape {
  Index rows, columns, depth;
};

class Products : public ::testing::TestWithParam<Shape> {};

TEST_P(Products, AreTheSameBitsFromEveryKernelAndTheSameAsEigens) {
  const auto [rows, columns, depth] = GetParam();
  Random random(1);
  const MatrixXd a = random_matrix(rows, depth, random), b = random_matrix(columns, depth, random);
  const MatrixXd before = random_matrix(rows, columns, random);
  const MatrixXd wanted = before - 2.0 * a * b.transpose();
  MatrixXd first;
  for (const ProductKernel* kernel : usable_product_kernels()) {
    MatrixXd sum = before;
    MatrixProduct(*kernel).add(a, b.transpose(), sum, -2.0);
    EXPECT_LT((sum - wanted).cwiseAbs().maxCoeff(), 1e-12 * static_cast<double>(depth + 1)) << kernel->name;
    if (first.size() == 0) first = sum;
    EXPECT_TRUE(sum == first) << kernel->name;
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Products,
                         ::testing::Values(Shape{1, 1, 1}, Shape{3, 5, 0}, Shape{8, 6, 256}, Shape{9, 7, 257},
                                           Shape{200, 31, 300}, Shape{65, 130, 513}, Shape{2, 4, 3}));

TEST(MatrixProduct, WritesOnlyItsTarget) {
  Random random(2);
  const MatrixXd a = random_matrix(10, 20, random), b = random_matrix(20, 9, random);
  MatrixXd large = MatrixXd::Constant(14, 13, 7.0);
  MatrixProduct().add(a, b, large.block(2, 3, 10, 9));
  const MatrixXd inside = large.block(2, 3, 10, 9);
  EXPECT_LT((inside.array() - 7.0 - (a * b).array()).abs().maxCoeff(), 1e-12);
  large.block(2, 3, 10, 9).setConstant(7.0);
  EXPECT_TRUE((large.array() == 7.0).all());
}

TEST(SpdInverse, IsTheInverseForEverySizeAndForgetsTheOneBefore) {
  Random random(3);
  SpdInverse inverse;
  for (const Index n : {1, 300, 47, 48, 49, 97, 200, 1}) {
    const MatrixXd root = random_matrix(n, n + 5, random);
    MatrixXd matrix = root * root.transpose() + MatrixXd::Identity(n, n);
    const MatrixXd full = matrix;
    matrix.triangularView<Eigen::StrictlyUpper>().setConstant(1e9);  // must not be read
    const MatrixXd* found = inverse(matrix);
    ASSERT_NE(found, nullptr) << n;
    EXPECT_LT((*found * full - MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-8) << n;
    EXPECT_TRUE(*found == found->transpose()) << n;
  }
}

TEST(SpdInverse, SaysThatAMatrixIsNotPositiveDefinite) {
  SpdInverse inverse;
  for (const Index at : {0, 60, 199}) {
    MatrixXd matrix = MatrixXd::Identity(200, 200);
    matrix(at, at) = -1e-3;
    EXPECT_EQ(inverse(matrix), nullptr);
  }
  EXPECT_NE(inverse(MatrixXd::Identity(200, 200)), nullptr);
}

}  // namespace
}  // namespace mstsl
