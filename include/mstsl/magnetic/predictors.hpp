#pragma once

#include "mstsl/magnetic/cross_validation.hpp"
#include "mstsl/magnetic/hyperparameters.hpp"

/// The three field models as plain functions from fingerprints to predictions: small scale, exact, for
/// held-out checks.
namespace mstsl {

/// Exact Gaussian-process regression; the variance is that of the field, without noise.
Predictor gpr_predictor(const FieldHyperparameters& hyperparameters);

/// Bilinear between nodes of a lattice; no variance of its own.
Predictor bilinear_predictor(double spacing_m);

/// The nearest fingerprint, if within `reach_m`; no variance of its own.
Predictor nearest_predictor(double reach_m);

}  // namespace mstsl
