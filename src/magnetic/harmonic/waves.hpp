#pragma once

#include <complex>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "../dense/matrix_product.hpp"
#include "tile.hpp"

namespace mstsl {

/// One number for each wave exp(i (a x + b y) 2 pi / period), a = 0 .. highest, b = -highest .. highest;
/// those of negative a are the conjugates.
class WaveTable {
 public:
  void set_zero(int highest) {
    highest_ = highest;
    real.setZero(highest + 1, 2 * highest + 1);
    imaginary.setZero(highest + 1, 2 * highest + 1);
  }
  int highest() const { return highest_; }
  std::complex<double> at(int a, int b) const {
    if (a < 0) return {real(-a, highest_ - b), -imaginary(-a, highest_ - b)};
    return {real(a, highest_ + b), imaginary(a, highest_ + b)};
  }
  void add(int a, int b, std::complex<double> value) {
    if (a < 0) return add(-a, -b, std::conj(value));
    real(a, highest_ + b) += value.real();
    imaginary(a, highest_ + b) += value.imag();
  }

  Eigen::MatrixXd real, imaginary;  ///< (a, highest + b)

 private:
  int highest_ = 0;
};

/// Cosines and sines of the numbers 0 .. highest at points, points x numbers.
struct Harmonics {
  void evaluate(const Eigen::VectorXd& points_m, double period_m, int highest);
  Eigen::MatrixXd cosine, sine;
};

/// Sum over samples of weight * exp(i k . x), for all waves.
void sum_over_samples(const Harmonics& x, const Harmonics& y, const Eigen::VectorXd& weights, int highest,
                      MatrixProduct& product, WaveTable& sums);

/// Real part of the sum over the table's waves at all cells of a tile (the same points along x and y),
/// (column, row).
void evaluate_at_cells(const WaveTable& table, const Harmonics& cells, MatrixProduct& product,
                       Eigen::MatrixXd& values);

/// The same at points that share no lattice.
void evaluate_at_points(const WaveTable& table, const Harmonics& x, const Harmonics& y,
                        MatrixProduct& product, Eigen::VectorXd& values);

/// What every tile of a map shares: the waves that are independent a priori, of unit variance each for cosine
/// and sine.
struct WaveBox {
  struct Wave {
    int a, b;                   ///< numbers of the wave; of each pair of opposite ones one is kept
    Eigen::Vector2d direction;  ///< of the wave vector
    double amplitude;           ///< of B_z, in units of the signal's SD
  };
  /// A wave too long for the box: between the lattice's zero and its first, where a wave alone would stand
  /// for too much.
  struct LongWave {
    Eigen::Vector2d direction;
    double per_m;  ///< wave number
    double amplitude;
  };
  WaveBox(const HarmonicTileOptions& options, const HarmonicFineness& fineness);

  HarmonicTileOptions options;
  int cells;
  double length_m, halo_m, period_m;
  std::vector<Wave> waves;
  std::vector<LongWave> long_waves;
  int highest = 0;                      ///< number of a wave along an axis
  Harmonics cell_harmonics;             ///< up to twice the highest
  Eigen::MatrixXd long_waves_at_cells;  ///< cells column by column (x first), see long_waves_at()
  Eigen::Array3d left_out;              ///< variance that the shorter waves would have
};

/// Cosines of all long waves at points, then their sines: points x 2 waves.
Eigen::MatrixXd long_waves_at(const WaveBox& box, const Eigen::MatrixX2d& points_m);

}  // namespace mstsl
