#pragma once

#include <optional>

#include <Eigen/Core>

namespace mstsl {

/// The inverse of a symmetric positive definite matrix (its lower triangle is read), full and symmetric;
/// nothing where it is not positive definite. Blocked so that all work is matrix products: twice as fast as
/// solving for the identity.
std::optional<Eigen::MatrixXd> spd_inverse(const Eigen::MatrixXd& matrix);

}  // namespace mstsl
