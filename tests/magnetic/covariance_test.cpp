#include "mstsl/magnetic/covariance.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"
#include "mstsl/magnetic/gaussian_process.hpp"

namespace mstsl {
namespace {

static_assert(CovarianceFunction<decltype(SquaredExponential{} * Matern32{} + Constant{} + WhiteNoise{})>);

std::vector<Eigen::Vector2d> random_points(Random& random, std::size_t count, double side_m) {
  std::vector<Eigen::Vector2d> points(count);
  for (auto& p : points) p = {random.uniform(0, side_m), random.uniform(0, side_m)};
  return points;
}

template <typename K>
class CovarianceLaws : public ::testing::Test {
 protected:
  static K some(Random& random) {
    std::array<double, K::kSize> logs;
    for (double& log : logs) log = random.uniform(-1.0, 1.0);
    return K::from_logs(logs);
  }
};

using AllKernels =
    ::testing::Types<Constant, WhiteNoise, SquaredExponential, SquaredExponentialXY, Matern32, Matern52,
                     Sum<SquaredExponential, WhiteNoise>, Product<Matern52, SquaredExponentialXY>,
                     Sum<Product<SquaredExponential, Matern32>, Sum<Constant, WhiteNoise>>>;
TYPED_TEST_SUITE(CovarianceLaws, AllKernels);

TYPED_TEST(CovarianceLaws, NoSetOfPointsHasANegativeVariance) {
  Random random(1);
  for (int trial = 0; trial < 5; ++trial) {
    const TypeParam kernel = this->some(random);
    const Eigen::MatrixXd k = covariance_matrix(kernel, random_points(random, 40, 4.0));
    const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues();
    EXPECT_GE(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff());
  }
}

TYPED_TEST(CovarianceLaws, TheCovarianceIsSymmetricAndLargestAtNoDistance) {
  Random random(2);
  const TypeParam kernel = this->some(random);
  for (const auto& d : random_points(random, 50, 3.0)) {
    EXPECT_DOUBLE_EQ(kernel(Lag{d, false}), kernel(Lag{-d, false}));
    EXPECT_LE(kernel(Lag{d, false}), kernel(Lag{{0, 0}, true}) * (1 + 1e-15));
  }
}

TYPED_TEST(CovarianceLaws, TheGradientIsThatOfFiniteDifferences) {
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    std::array<double, TypeParam::kSize> logs;
    for (double& log : logs) log = random.uniform(-1.0, 1.0);
    const Lag lag{{random.uniform(-2, 2), random.uniform(-2, 2)}, trial % 2 == 0};
    const auto analytic = TypeParam::from_logs(logs).with_gradient(lag);
    EXPECT_DOUBLE_EQ(analytic.value, TypeParam::from_logs(logs)(lag));
    for (std::size_t p = 0; p < logs.size(); ++p) {
      auto up = logs, down = logs;
      up[p] += 1e-5;
      down[p] -= 1e-5;
      const double numeric = (TypeParam::from_logs(up)(lag) - TypeParam::from_logs(down)(lag)) / 2e-5;
      EXPECT_NEAR(analytic.by_log_parameter[p], numeric, 1e-8 * (1 + std::abs(numeric)));
    }
  }
}

TYPED_TEST(CovarianceLaws, ParametersReadBackAsTheLogsTheyWereMadeFrom) {
  Random random(4);
  std::array<double, TypeParam::kSize> logs;
  for (double& log : logs) log = random.uniform(-1.0, 1.0);
  const auto parameters = TypeParam::from_logs(logs).parameters();
  for (std::size_t p = 0; p < logs.size(); ++p) {
    EXPECT_NEAR(std::log(parameters[p].value), logs[p], 1e-14);
    EXPECT_FALSE(parameters[p].name.empty());
    EXPECT_FALSE(parameters[p].unit.empty());
  }
}

TEST(Covariance, SumsAddAndProductsMultiply) {
  const SquaredExponential a{2.0, 0.7};
  const Matern32 b{1.5, 1.1};
  const WhiteNoise c{0.3};
  for (const bool same : {false, true}) {
    const Lag lag{{same ? 0.0 : 0.4, same ? 0.0 : -0.2}, same};
    EXPECT_DOUBLE_EQ((a + b)(lag), a(lag) + b(lag));
    EXPECT_DOUBLE_EQ((b + a)(lag), (a + b)(lag));
    EXPECT_DOUBLE_EQ((a * b)(lag), a(lag) * b(lag));
    EXPECT_DOUBLE_EQ(((a + b) * c)(lag), (a * c + b * c)(lag));
  }
}

TEST(Covariance, AnAxisProductOfSquaredExponentialsIsTheRoundOne) {
  const SquaredExponential round{3.0, 0.8};
  const SquaredExponentialXY separable{3.0, 0.8, 0.8};
  for (const double x : {0.0, 0.3, 1.7}) EXPECT_NEAR(round(Lag{{x, 0.5}}), separable(Lag{{x, 0.5}}), 1e-14);
}

TEST(Covariance, HandComputedValues) {
  EXPECT_NEAR((SquaredExponential{2.0, 0.5}(Lag{{0.3, 0.4}})), 4.0 * std::exp(-0.5), 1e-14);
  EXPECT_NEAR((Matern32{1.0, 1.0}(Lag{{1.0, 0.0}})), (1 + std::sqrt(3.0)) * std::exp(-std::sqrt(3.0)), 1e-14);
  EXPECT_NEAR((Matern52{1.0, 1.0}(Lag{{0.0, 1.0}})),
              (1 + std::sqrt(5.0) + 5.0 / 3) * std::exp(-std::sqrt(5.0)), 1e-14);
}

}  // namespace
}  // namespace mstsl
