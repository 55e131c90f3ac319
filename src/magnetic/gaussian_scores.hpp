#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/parallel.hpp"
#include "mstsl/magnetic/matcher.hpp"

namespace mstsl {

/// Means and variances of all places, component by component, so that whole arrays are worked on at once.
struct PlaceFields {
  std::array<Eigen::ArrayXf, 3> mean_uT;
  std::array<Eigen::ArrayXf, 3> variance_uT2;
  Eigen::Index size() const { return mean_uT[0].size(); }
};

/// Paper Eq. 2: the log of the multivariate Gaussian density of the observation at each place.
std::vector<float> gaussian_log_densities(const PlaceFields& places, const FieldObservation& observation,
                                          Threads threads);

}  // namespace mstsl
