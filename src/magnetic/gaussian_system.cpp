#include <cmath>
#include <utility>

#include "mstsl/core/angles.hpp"
#include "mstsl/magnetic/gaussian_process.hpp"

namespace mstsl {
namespace {

/// Cholesky factor of a covariance; raises the diagonal in steps until rounding no longer spoils it.
Result<Eigen::LLT<Eigen::MatrixXd>> factorise(Eigen::MatrixXd& covariance) {
  const double scale = covariance.diagonal().mean();
  double raised = 0.0;
  for (const double jitter : {0.0, 1e-12, 1e-10, 1e-8, 1e-6}) {
    covariance.diagonal().array() += (jitter - raised) * scale;
    raised = jitter;
    Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    if (factor.info() == Eigen::Success) return factor;
  }
  return Error("the covariance matrix of the samples is not positive definite");
}

}  // namespace

Result<GaussianSystem> GaussianSystem::make(Eigen::MatrixXd covariance, Eigen::MatrixXd values,
                                            bool estimate_mean) {
  assert(covariance.rows() == covariance.cols() && covariance.rows() == values.rows());
  if (values.rows() == 0) return Error("a regression needs at least one sample");
  if (!values.allFinite() || !covariance.allFinite())
    return Error("a regression was given values that are not finite");
  auto factor = factorise(covariance);
  if (!factor) return factor.error();
  GaussianSystem system;
  system.factor_ = std::move(*factor);
  system.mean_ = Eigen::RowVectorXd::Zero(values.cols());
  if (estimate_mean) {
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(values.rows());
    const Eigen::VectorXd weight = system.factor_.solve(ones);
    system.mean_ = weight.transpose() * values / weight.sum();
  }
  system.residual_ = values.rowwise() - system.mean_;
  system.weights_ = system.factor_.solve(system.residual_);
  return system;
}

Eigen::MatrixXd GaussianSystem::predict_mean(const Eigen::MatrixXd& cross) const {
  return (cross * weights_).rowwise() + mean_;
}

Eigen::VectorXd GaussianSystem::predict_variance(const Eigen::MatrixXd& cross,
                                                 const Eigen::VectorXd& prior) const {
  const Eigen::MatrixXd v = factor_.matrixL().solve(cross.transpose());
  return (prior - v.colwise().squaredNorm().transpose()).cwiseMax(0.0);
}

double GaussianSystem::log_marginal_likelihood() const {
  const double fit = residual_.cwiseProduct(weights_).sum();
  const double half_log_determinant = factor_.matrixLLT().diagonal().array().log().sum();
  const auto columns = static_cast<double>(weights_.cols());
  return -0.5 * fit -
         columns * (half_log_determinant + 0.5 * static_cast<double>(size()) * std::log(2 * kPi));
}

Eigen::MatrixXd GaussianSystem::inverse() const {
  return factor_.solve(Eigen::MatrixXd::Identity(size(), size()));
}

GaussianSystem::HeldOut GaussianSystem::leave_out(const Eigen::MatrixXd& inverse,
                                                  const Eigen::MatrixXd& weights,
                                                  std::span<const Eigen::Index> held_out) {
  const auto m = static_cast<Eigen::Index>(held_out.size());
  Eigen::MatrixXd block(m, m);
  Eigen::MatrixXd rows(m, weights.cols());
  for (Eigen::Index i = 0; i < m; ++i) {
    rows.row(i) = weights.row(held_out[i]);
    for (Eigen::Index j = 0; j < m; ++j) block(i, j) = inverse(held_out[i], held_out[j]);
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(block);
  return {factor.solve(rows), factor.solve(Eigen::MatrixXd::Identity(m, m))};
}

}  // namespace mstsl
