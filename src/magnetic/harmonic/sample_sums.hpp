#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waves.hpp"

namespace mstsl {

/// All that a tile's normal equations need of its samples, whatever their number.
struct SampleSums {
  void sum(const WaveBox& box, std::span<const TileSample> samples, MatrixProduct& product);

  std::vector<Eigen::Index> near;              ///< the samples that are in tile and halo
  Harmonics x, y;                              ///< at them
  Eigen::MatrixXd long_columns;                ///< long waves at them
  WaveTable weights;                           ///< summed over samples
  std::array<WaveTable, 3> values;             ///< the same times their values
  std::vector<WaveTable> long_sums;            ///< weights times each column of long waves, summed
  Eigen::MatrixXd long_products, long_values;  ///< the same columns times each other, and times the values

 private:
  void sum_long_waves(const WaveBox& box, const Eigen::VectorXd& w, const Eigen::MatrixXd& readings,
                      MatrixProduct& product);
};

}  // namespace mstsl
