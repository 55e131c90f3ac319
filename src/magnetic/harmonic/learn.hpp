#pragma once

#include <optional>
#include <span>

#include "mstsl/magnetic/fingerprint.hpp"
#include "mstsl/magnetic/harmonic_covariance.hpp"
#include "mstsl/magnetic/learn_hyperparameters.hpp"

namespace mstsl {

/// Side, depth and noise of the harmonic covariance by maximum marginal likelihood over blocks, as
/// learn_hyperparameters() does for independent components; that one's results give mean and start. The
/// signal is the survey's own. Noise is one for the horizontal components, which share the heading's error,
/// and one for B_z. Nothing where the fingerprints are too few for a block.
std::optional<HarmonicHyperparameters> learn_harmonic(std::span<const Fingerprint> fingerprints,
                                                      const FieldHyperparameters& independent,
                                                      const LearningOptions& options);

}  // namespace mstsl
