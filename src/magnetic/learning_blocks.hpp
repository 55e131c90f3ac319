#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/magnetic/fingerprint.hpp"
#include "mstsl/magnetic/learn_hyperparameters.hpp"

/// What hyper-parameters are learned from: pieces of a survey that are small enough for exact algebra.
namespace mstsl {

/// Mean and standard deviation of each component over the surveyed area, every half metre counting once.
struct Moments {
  Eigen::Array3d mean, sd;
};
Moments moments_over_area(std::span<const Fingerprint> fingerprints,
                          const std::vector<Eigen::Vector2d>& points_m);

/// Squares of the given side, spread evenly over those that hold enough samples.
std::vector<std::vector<Fingerprint>> learning_blocks(std::span<const Fingerprint> fingerprints,
                                                      double side_m, const LearningOptions& options);

}  // namespace mstsl
