#pragma once

#include <span>
#include <vector>

#include "mstsl/magnetic/variance_calibration.hpp"

/// Noise of which one in a hundred comes with ten times the standard deviation: a trolley that passed, a pose
/// that jumped (contaminated normal, Tukey 1960).
namespace mstsl {

/// Weight of something of which `components` were measured, their deviations in standard deviations squared
/// and summed: the expected inverse variance, relative to that of good ones. 1 for good ones, 1/2 at a
/// squared sum of 23 for three components.
double noise_weight(double squared_deviations, int components);

/// Log of the density of an error's three components under such noise, without the constant.
double contaminated_log_density(const HeldOutError& error, const VarianceCalibration& calibration);

/// The calibration of the errors that such noise takes for good ones (weight above 1/2) under it.
VarianceCalibration calibrate_good_ones(std::span<const HeldOutError> errors,
                                        const VarianceCalibration& prior);

}  // namespace mstsl
