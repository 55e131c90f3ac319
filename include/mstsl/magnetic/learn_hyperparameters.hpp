#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mstsl/core/parallel.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/magnetic/fingerprint.hpp"
#include "mstsl/magnetic/hyperparameters.hpp"

namespace mstsl {

struct LearningOptions {
  /// Side of the blocks, in length scales: shorter ones cannot tell a long length scale from a slope.
  double block_side = 7.0;
  std::size_t blocks = 12;  ///< spread evenly over the survey; more change the result by a few per cent
  std::size_t samples_per_block = 240;  ///< pairs of neighbouring fingerprints, spread evenly over the drive
  Threads threads;
};

struct LearnedHyperparameters {
  FieldHyperparameters values;
  std::size_t blocks = 0;
  std::size_t samples = 0;
  double log_likelihood_per_sample = 0.0;
  std::vector<std::string> warnings;  ///< where the data could not tell
};

/// Learns what the regression assumes from the fingerprints, by maximum marginal likelihood (R&W
/// Eq. 2.30, 5.9) summed over independent blocks.
///
/// The signal's standard deviation is the survey's own, per component, and is not learned: along dense lanes
/// the likelihood likes a smooth and huge field just as well (amplitudes of 20-29 uT for a field of 7 uT),
/// and between the lanes that does harm. Length scale and noise ratio are shared by the three components: on
/// the recordings at hand own values per component predicted held-out passes no better (6 of 9 times worse),
/// and sharing lets one factorisation serve all three. Weak priors (correlation 0.4-3 m, noise about a tenth
/// of the signal) decide where the data do not. Errors: fewer than 20 fingerprints, values that are not
/// finite.
Result<LearnedHyperparameters> learn_hyperparameters(std::span<const Fingerprint> fingerprints,
                                                     const LearningOptions& options = {});

}  // namespace mstsl
