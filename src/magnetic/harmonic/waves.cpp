#include "waves.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Wave number times depth beyond which waves tell less than `tolerance` of what the prior knows. The power
/// of the sheet falls as k exp(-k D); `information` is that of the samples within a depth squared.
double shortest_wave(double information, double tolerance) {
  constexpr double kLeast = 3.0, kStep = 0.05, kMost = 40.0;
  double u = kLeast;
  while (u < kMost && information * u * std::exp(-u) > tolerance) u += kStep;
  return u;
}

/// Of a wave of number k that stands for a square of `side` in the plane of wave numbers and for the opposite
/// one, both in units of 1 / depth: the sheet's spectrum 2 pi exp(-k) / k, times k^2.
double amplitude(double k, double side) { return side * std::sqrt(k * std::exp(-k) / (2 * kPi)); }

}  // namespace

void Harmonics::evaluate(const VectorXd& points_m, double period_m, int highest) {
  cosine.resize(points_m.size(), highest + 1);
  sine.resize(points_m.size(), highest + 1);
  for (int a = 0; a <= highest; ++a) {
    const double k = 2 * kPi * a / period_m;
    cosine.col(a) = (k * points_m).array().cos();
    sine.col(a) = (k * points_m).array().sin();
  }
}

void sum_over_samples(const Harmonics& x, const Harmonics& y, const VectorXd& weights, int highest,
                      MatrixProduct& product, WaveTable& sums) {
  sums.set_zero(highest);
  const int n = highest + 1;
  const MatrixXd wx = weights.asDiagonal() * x.cosine.leftCols(n),
                 vx = weights.asDiagonal() * x.sine.leftCols(n);
  const auto cy = y.cosine.leftCols(n), sy = y.sine.leftCols(n);
  MatrixXd cc = MatrixXd::Zero(n, n), ss = cc, cs = cc, sc = cc;
  product.add(wx.transpose(), cy, cc);
  product.add(vx.transpose(), sy, ss);
  product.add(wx.transpose(), sy, cs);
  product.add(vx.transpose(), cy, sc);
  sums.real.rightCols(n) = cc - ss;
  sums.imaginary.rightCols(n) = cs + sc;
  sums.real.leftCols(n) = (cc + ss).rowwise().reverse();
  sums.imaginary.leftCols(n) = (sc - cs).rowwise().reverse();
}

namespace {

/// Sum over the waves along x, for each of those along y: real and imaginary part, points x waves.
struct AlongX {
  MatrixXd real, imaginary;
};
AlongX sum_along_x(const WaveTable& table, const Harmonics& x, MatrixProduct& product) {
  const int n = table.highest() + 1;
  const auto cosine = x.cosine.leftCols(n), sine = x.sine.leftCols(n);
  AlongX sum{MatrixXd::Zero(cosine.rows(), 2 * n - 1), MatrixXd::Zero(cosine.rows(), 2 * n - 1)};
  product.add(cosine, table.real, sum.real);
  product.add(sine, table.imaginary, sum.real, -1.0);
  product.add(cosine, table.imaginary, sum.imaginary);
  product.add(sine, table.real, sum.imaginary);
  return sum;
}

/// Cosines and sines of the numbers -highest .. highest.
Harmonics both_ways(const Harmonics& y, int highest) {
  const int n = highest + 1;
  Harmonics both;
  both.cosine.resize(y.cosine.rows(), 2 * n - 1);
  both.sine.resize(y.cosine.rows(), 2 * n - 1);
  both.cosine << y.cosine.middleCols(1, n - 1).rowwise().reverse(), y.cosine.leftCols(n);
  both.sine << -y.sine.middleCols(1, n - 1).rowwise().reverse(), y.sine.leftCols(n);
  return both;
}

}  // namespace

void evaluate_at_cells(const WaveTable& table, const Harmonics& cells, MatrixProduct& product,
                       MatrixXd& values) {
  const AlongX sum = sum_along_x(table, cells, product);
  const Harmonics y = both_ways(cells, table.highest());
  values.setZero(sum.real.rows(), y.cosine.rows());
  product.add(sum.real, y.cosine.transpose(), values);
  product.add(sum.imaginary, y.sine.transpose(), values, -1.0);
}

void evaluate_at_points(const WaveTable& table, const Harmonics& x, const Harmonics& y,
                        MatrixProduct& product, VectorXd& values) {
  const AlongX sum = sum_along_x(table, x, product);
  const Harmonics both = both_ways(y, table.highest());
  values = (sum.real.cwiseProduct(both.cosine) - sum.imaginary.cwiseProduct(both.sine)).rowwise().sum();
}

MatrixXd long_waves_at(const WaveBox& box, const Eigen::MatrixX2d& points_m) {
  const auto n = static_cast<Eigen::Index>(box.long_waves.size());
  MatrixXd values(points_m.rows(), 2 * n);
  for (Eigen::Index l = 0; l < n; ++l) {
    const WaveBox::LongWave& wave = box.long_waves[static_cast<std::size_t>(l)];
    const Eigen::ArrayXd phase = points_m * (wave.per_m * wave.direction);
    values.col(l) = phase.cos();
    values.col(n + l) = phase.sin();
  }
  return values;
}

WaveBox::WaveBox(const HarmonicTileOptions& o, const HarmonicFineness& fineness) : options(o) {
  const double depth_m = o.field.depth_m;
  cells =
      o.cells > 0 ? o.cells : std::max(4, static_cast<int>(std::lround(fineness.side * depth_m / o.cell_m)));
  length_m = cells * o.cell_m;
  halo_m = fineness.halo * depth_m;
  period_m = length_m + (2 * fineness.halo + fineness.margin) * depth_m;
  const double noise = (o.field.noise_sd_uT / o.field.signal_sd_uT).minCoeff();
  const double u =
      shortest_wave(kPi * o.samples_per_m2 * depth_m * depth_m / (noise * noise), fineness.tolerance);
  const double step = 2 * kPi * depth_m / period_m;
  const int most = static_cast<int>(u / step);
  for (int a = 0; a <= most; ++a)
    for (int b = a == 0 ? 1 : -most; b <= most; ++b) {
      const double k = step * std::hypot(a, b);
      if (k > u) continue;
      waves.push_back({a, b, Eigen::Vector2d(a, b).normalized(), amplitude(k, step)});
      highest = std::max({highest, a, std::abs(b)});
    }
  // The lattice's cell around zero in nine, the one around zero in nine again.
  for (const double part : {step / 3, step / 9})
    for (const auto& [a, b] : {std::pair{0, 1}, {1, -1}, {1, 0}, {1, 1}}) {
      const double k = part * std::hypot(a, b);
      long_waves.push_back({Eigen::Vector2d(a, b).normalized(), k / depth_m, amplitude(k, part)});
    }
  VectorXd centers_m(cells);
  for (int i = 0; i < cells; ++i) centers_m(i) = (i + 0.5) * o.cell_m;
  cell_harmonics.evaluate(centers_m, period_m, 2 * highest);
  Eigen::MatrixX2d places_m(cells * cells, 2);
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column)
      places_m.row(row * cells + column) << centers_m(column), centers_m(row);
  long_waves_at_cells = long_waves_at(*this, places_m);
  const double vertical = std::exp(-u) * (u * u + 2 * u + 2) / 2;
  left_out = {vertical / 2, vertical / 2, vertical};
}

}  // namespace mstsl
