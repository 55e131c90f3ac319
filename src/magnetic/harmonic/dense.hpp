#pragma once

#include <span>

#include <Eigen/Core>

#include "mstsl/core/result.hpp"
#include "mstsl/magnetic/cross_validation.hpp"
#include "mstsl/magnetic/harmonic_covariance.hpp"

/// Exact regression with the harmonic covariance: three rows a fingerprint, cost (3 n)^3.
namespace mstsl {

/// Covariance of the fields at two sets of points in uT^2, all x first, then all y, all z; without noise.
Eigen::MatrixXd harmonic_covariance(const HarmonicHyperparameters& h, std::span<const Eigen::Vector2d> rows_m,
                                    std::span<const Eigen::Vector2d> columns_m);

/// Deviations from the mean in the same order.
Eigen::VectorXd stacked(const HarmonicHyperparameters& h, std::span<const Fingerprint> fingerprints);

/// The variance is that of the field, without noise.
Predictor harmonic_predictor(const HarmonicHyperparameters& h);

}  // namespace mstsl
