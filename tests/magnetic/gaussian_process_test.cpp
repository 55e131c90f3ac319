#include "mstsl/magnetic/gaussian_process.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

#include "test_support.hpp"

namespace mstsl {
namespace {

using test::must;
using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

struct Samples {
  std::vector<Eigen::Vector2d> points;
  Eigen::MatrixXd values;
};

Samples random_samples(std::uint64_t seed, Eigen::Index count) {
  Random random(seed);
  Samples s{std::vector<Eigen::Vector2d>(static_cast<std::size_t>(count)), Eigen::MatrixXd(count, 3)};
  for (Eigen::Index i = 0; i < count; ++i) {
    s.points[i] = {random.uniform(0, 3), random.uniform(0, 3)};
    for (int c = 0; c < 3; ++c)
      s.values(i, c) = 20 * (c - 1) + 5 * std::sin(2 * s.points[i].x() + c) + random.normal(0, 0.4);
  }
  return s;
}

/// The textbook formulas once more, written out in long double with LU instead of Cholesky.
struct Oracle {
  LongMatrix mean, variance;
  long double log_likelihood = 0;
};

template <typename K>
Oracle solve_directly(const K& kernel, const Samples& s, const std::vector<Eigen::Vector2d>& queries) {
  const auto n = static_cast<Eigen::Index>(s.points.size());
  const auto m = static_cast<Eigen::Index>(queries.size());
  LongMatrix k(n, n), cross(m, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) k(i, j) = kernel(Lag{s.points[i] - s.points[j], i == j});
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < n; ++j) cross(i, j) = kernel(Lag{queries[i] - s.points[j], false});
  const Eigen::FullPivLU<LongMatrix> lu(k);
  const LongMatrix inverse = lu.inverse();
  const LongMatrix ones = LongMatrix::Ones(n, 1);
  const LongMatrix y = s.values.cast<long double>();
  const LongMatrix mean = (ones.transpose() * inverse * y) / (ones.transpose() * inverse * ones)(0, 0);
  const LongMatrix residual = y - ones * mean;
  Oracle oracle;
  oracle.mean = cross * inverse * residual + LongMatrix::Ones(m, 1) * mean;
  oracle.variance = LongMatrix(m, 1);
  for (Eigen::Index i = 0; i < m; ++i)
    oracle.variance(i, 0) = kernel(Lag{}) - (cross.row(i) * inverse * cross.row(i).transpose())(0, 0);
  const long double two_pi = 2 * 3.14159265358979323846L;
  for (Eigen::Index c = 0; c < y.cols(); ++c)
    oracle.log_likelihood -=
        0.5L * ((residual.col(c).transpose() * inverse * residual.col(c))(0, 0) + std::log(lu.determinant()) +
                static_cast<long double>(n) * std::log(two_pi));
  return oracle;
}

TEST(ExactRegression, AgreesWithTheTextbookFormulasInLongDouble) {
  const Samples s = random_samples(1, 60);
  const auto kernel = SquaredExponential{5.0, 0.7} + Matern32{2.0, 0.3} + WhiteNoise{0.4};
  const std::vector<Eigen::Vector2d> queries{{1.0, 1.0}, {0.2, 2.9}, {-5.0, 1.0}, s.points[3]};
  const auto regression = must(fit_exactly(kernel, s.points, s.values));
  const auto prediction = regression.predict(queries);
  const Oracle oracle = solve_directly(kernel, s, queries);
  EXPECT_LT((prediction.mean - oracle.mean.cast<double>()).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((prediction.variance - oracle.variance.cast<double>()).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(regression.system().log_marginal_likelihood(), static_cast<double>(oracle.log_likelihood),
              1e-8);
}

TEST(ExactRegression, FarFromSamplesReturnsToMeanAndPriorVariance) {
  const Samples s = random_samples(2, 40);
  const auto kernel = SquaredExponential{5.0, 0.7} + WhiteNoise{0.4};
  const auto regression = must(fit_exactly(kernel, s.points, s.values));
  const auto far = regression.predict(std::vector<Eigen::Vector2d>{{1000.0, 0.0}});
  EXPECT_NEAR(far.variance(0), 25.0, 1e-9);
  EXPECT_LT((far.mean.row(0) - regression.system().mean()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(ExactRegression, DuplicatedPointsWithoutNoiseStillGiveFiniteAnswers) {
  Samples s = random_samples(3, 30);
  s.points[1] = s.points[0];
  s.values.row(1) = s.values.row(0);
  const SquaredExponential kernel{5.0, 0.7};
  const auto prediction = must(fit_exactly(kernel, s.points, s.values)).predict(s.points);
  EXPECT_TRUE(prediction.mean.allFinite());
  EXPECT_GE(prediction.variance.minCoeff(), 0.0);
}

TEST(ExactRegression, ValuesThatAreNotFiniteAreAnError) {
  Samples s = random_samples(4, 10);
  s.values(3, 1) = std::numeric_limits<double>::quiet_NaN();
  const auto result = fit_exactly(SquaredExponential{5.0, 0.7}, s.points, s.values);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message().find("not finite"), std::string::npos);
}

TEST(LogMarginalLikelihood, ItsGradientIsThatOfFiniteDifferences) {
  const Samples s = random_samples(5, 50);
  using K = Sum<SquaredExponentialXY, Sum<Matern52, WhiteNoise>>;
  std::array<double, K::kSize> logs{std::log(5.0), std::log(0.7), std::log(0.9),
                                    std::log(2.0), std::log(0.4), std::log(0.5)};
  for (const bool estimate_mean : {false, true}) {
    const auto analytic =
        must(log_marginal_likelihood(K::from_logs(logs), s.points, s.values, estimate_mean));
    for (std::size_t p = 0; p < logs.size(); ++p) {
      auto up = logs, down = logs;
      up[p] += 1e-5;
      down[p] -= 1e-5;
      const double numeric =
          (must(log_marginal_likelihood(K::from_logs(up), s.points, s.values, estimate_mean)).value -
           must(log_marginal_likelihood(K::from_logs(down), s.points, s.values, estimate_mean)).value) /
          2e-5;
      EXPECT_NEAR(analytic.by_log_parameter[p], numeric, 1e-4 * (1 + std::abs(numeric))) << "parameter " << p;
    }
  }
}

TEST(LeaveOut, EqualsARegressionThatNeverSawTheGroup) {
  const Samples s = random_samples(6, 40);
  const auto kernel = SquaredExponential{5.0, 0.7} + WhiteNoise{0.4};
  const auto system = must(GaussianSystem::make(covariance_matrix(kernel, s.points), s.values, false));
  const std::vector<Eigen::Index> group{0, 1, 2, 3, 4};
  const auto held_out = GaussianSystem::leave_out(system.inverse(), system.weights(), group);
  const std::vector<Eigen::Vector2d> rest(s.points.begin() + 5, s.points.end());
  const std::vector<Eigen::Vector2d> queries(s.points.begin(), s.points.begin() + 5);
  const auto without = must(fit_exactly(kernel, rest, s.values.bottomRows(35), false)).predict(queries);
  EXPECT_LT((held_out.error - (s.values.topRows(5) - without.mean)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((held_out.covariance.diagonal().array() - 0.16 - without.variance.array()).abs().maxCoeff(),
            1e-9);
}

TEST(ExactRegression, ShiftingOrTurningTheCoordinatesChangesNothing) {
  const Samples s = random_samples(7, 40);
  const auto kernel = SquaredExponential{5.0, 0.7} + WhiteNoise{0.4};
  const std::vector<Eigen::Vector2d> queries{{1.0, 2.0}, {2.5, 0.3}};
  const auto turn = [](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    return Eigen::Rotation2Dd(0.8) * p + Eigen::Vector2d(100.0, -40.0);
  };
  std::vector<Eigen::Vector2d> turned_points, turned_queries;
  for (const auto& p : s.points) turned_points.push_back(turn(p));
  for (const auto& p : queries) turned_queries.push_back(turn(p));
  const auto a = must(fit_exactly(kernel, s.points, s.values)).predict(queries);
  const auto b = must(fit_exactly(kernel, turned_points, s.values)).predict(turned_queries);
  EXPECT_LT((a.mean - b.mean).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((a.variance - b.variance).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(ExactRegression, ScalingTheUnitsScalesTheAnswer) {
  const Samples s = random_samples(8, 40);
  const std::vector<Eigen::Vector2d> queries{{1.0, 2.0}, {2.5, 0.3}};
  const auto kernel = SquaredExponential{5.0, 0.7} + WhiteNoise{0.4};
  const auto in_tesla = SquaredExponential{5.0e-6, 0.7} + WhiteNoise{0.4e-6};
  const auto a = must(fit_exactly(kernel, s.points, s.values)).predict(queries);
  const auto b = must(fit_exactly(in_tesla, s.points, s.values * 1e-6)).predict(queries);
  EXPECT_LT((a.mean - b.mean * 1e6).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((a.variance - b.variance * 1e12).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace mstsl
