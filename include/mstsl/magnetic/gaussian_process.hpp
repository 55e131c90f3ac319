#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "mstsl/core/result.hpp"
#include "mstsl/magnetic/covariance.hpp"

/// Exact Gaussian-process regression by dense algebra (Rasmussen & Williams, chapter 2): cost n^3. It is the
/// oracle that the fast engines are held against, and the engine for blocks of a few hundred fingerprints.
namespace mstsl {

/// Covariance of samples with themselves, n x n; noise on the diagonal.
template <CovarianceFunction K>
Eigen::MatrixXd covariance_matrix(const K& kernel, std::span<const Eigen::Vector2d> points_m) {
  const auto n = static_cast<Eigen::Index>(points_m.size());
  Eigen::MatrixXd k(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i) k(i, j) = k(j, i) = kernel(Lag{points_m[i] - points_m[j], i == j});
  return k;
}

/// Covariance between two sets of different samples, rows by columns.
template <CovarianceFunction K>
Eigen::MatrixXd cross_covariance(const K& kernel, std::span<const Eigen::Vector2d> row_points_m,
                                 std::span<const Eigen::Vector2d> column_points_m) {
  Eigen::MatrixXd k(row_points_m.size(), column_points_m.size());
  for (Eigen::Index j = 0; j < k.cols(); ++j)
    for (Eigen::Index i = 0; i < k.rows(); ++i)
      k(i, j) = kernel(Lag{row_points_m[i] - column_points_m[j], false});
  return k;
}

/// A covariance matrix, factorised, with the samples' values: everything that prediction and learning ask
/// for. Columns of `values` are independent fields over the same points that share the covariance.
class GaussianSystem {
 public:
  /// Subtracts the generalised least-squares mean of each column first where `estimate_mean`. Duplicated
  /// samples with next to no noise make the matrix singular: the diagonal is then raised, at most by 1e-6 of
  /// its mean. Errors: values or covariances that are not finite, a matrix that is no covariance.
  static Result<GaussianSystem> make(Eigen::MatrixXd covariance, Eigen::MatrixXd values, bool estimate_mean);

  Eigen::Index size() const { return weights_.rows(); }
  const Eigen::RowVectorXd& mean() const { return mean_; }
  /// K^-1 (y - mean), n x columns.
  const Eigen::MatrixXd& weights() const { return weights_; }

  /// R&W Eq. 2.25: posterior means, points x columns, given the cross covariance of points (rows) and
  /// samples.
  Eigen::MatrixXd predict_mean(const Eigen::MatrixXd& cross) const;
  /// R&W Eq. 2.26: posterior variances given also the prior variance at each point. Never negative.
  Eigen::VectorXd predict_variance(const Eigen::MatrixXd& cross, const Eigen::VectorXd& prior) const;
  /// R&W Eq. 2.30, summed over the columns.
  double log_marginal_likelihood() const;
  /// K^-1, n x n.
  Eigen::MatrixXd inverse() const;

  /// What each sample of `held_out` (indices) would be predicted as from all other samples, and the
  /// covariance of that prediction's error, noise included: R&W Eq. 5.12 for a group instead of a single
  /// sample.
  struct HeldOut {
    Eigen::MatrixXd error;       ///< value - prediction, group x columns
    Eigen::MatrixXd covariance;  ///< group x group
  };
  static HeldOut leave_out(const Eigen::MatrixXd& inverse, const Eigen::MatrixXd& weights,
                           std::span<const Eigen::Index> held_out);

 private:
  GaussianSystem() = default;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::RowVectorXd mean_;
  Eigen::MatrixXd residual_;
  Eigen::MatrixXd weights_;
};

template <std::size_t N>
struct LogLikelihood {
  double value = 0.0;
  std::array<double, N> by_log_parameter{};
};

/// The log marginal likelihood and its gradient by the logs of the kernel's parameters (R&W Eq. 2.30
/// and 5.9).
template <CovarianceFunction K>
Result<LogLikelihood<K::kSize>> log_marginal_likelihood(const K& kernel,
                                                        std::span<const Eigen::Vector2d> points_m,
                                                        const Eigen::MatrixXd& values, bool estimate_mean) {
  const auto n = static_cast<Eigen::Index>(points_m.size());
  Result<GaussianSystem> system =
      GaussianSystem::make(covariance_matrix(kernel, points_m), values, estimate_mean);
  if (!system) return system.error();
  LogLikelihood<K::kSize> result{system->log_marginal_likelihood(), {}};
  const Eigen::MatrixXd& a = system->weights();
  // d/dtheta = 1/2 tr((a a^T - columns * K^-1) dK/dtheta); symmetric, so the lower triangle is enough.
  const Eigen::MatrixXd m = a * a.transpose() - static_cast<double>(values.cols()) * system->inverse();
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i) {
      const auto k = kernel.with_gradient(Lag{points_m[i] - points_m[j], i == j});
      const double weight = (i == j ? 0.5 : 1.0) * m(i, j);
      for (std::size_t p = 0; p < K::kSize; ++p) result.by_log_parameter[p] += weight * k.by_log_parameter[p];
    }
  return result;
}

/// Exact regression with any covariance function, made by fit_exactly().
template <CovarianceFunction K>
class ExactRegression {
 public:
  ExactRegression(const K& kernel, std::vector<Eigen::Vector2d> points_m, GaussianSystem system)
      : kernel_(kernel), points_(std::move(points_m)), system_(std::move(system)) {}

  struct Prediction {
    Eigen::MatrixXd mean;      ///< points x columns
    Eigen::VectorXd variance;  ///< of the field itself, without the noise of a reading
  };
  Prediction predict(std::span<const Eigen::Vector2d> points_m) const {
    const Eigen::MatrixXd cross = cross_covariance(kernel_, points_m, points_);
    const Eigen::VectorXd prior = Eigen::VectorXd::Constant(cross.rows(), kernel_(Lag{}));
    return {system_.predict_mean(cross), system_.predict_variance(cross, prior)};
  }
  const GaussianSystem& system() const { return system_; }

 private:
  K kernel_;
  std::vector<Eigen::Vector2d> points_;
  GaussianSystem system_;
};

/// `values`: one row a point, one column a field (R&W Algorithm 2.1).
template <CovarianceFunction K>
Result<ExactRegression<K>> fit_exactly(const K& kernel, std::span<const Eigen::Vector2d> points_m,
                                       const Eigen::MatrixXd& values, bool estimate_mean = true) {
  Result<GaussianSystem> system =
      GaussianSystem::make(covariance_matrix(kernel, points_m), values, estimate_mean);
  if (!system) return system.error();
  return ExactRegression<K>(kernel, {points_m.begin(), points_m.end()}, std::move(*system));
}

}  // namespace mstsl
