#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "mstsl/magnetic/learn_hyperparameters.hpp"
#include "mstsl/magnetic/survey_analysis.hpp"

namespace mstsl {

/// Fingerprints that a held-out stretch is foretold from with the harmonic covariance: three rows each.
inline constexpr std::size_t kHarmonicTraining = 250;

/// Learns the harmonic covariance and holds it against independent components on held-out lanes. Nothing
/// where the survey is too small for one or the other.
std::optional<KernelComparison> compare_kernels(std::span<const Fingerprint> fingerprints,
                                                const FieldHyperparameters& independent,
                                                const LearningOptions& learning);

}  // namespace mstsl
