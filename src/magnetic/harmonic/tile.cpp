#include "tile.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "../dense/spd_inverse.hpp"
#include "waves.hpp"

namespace mstsl {
namespace {

using Complex = std::complex<double>;
using Eigen::Array3d;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Wave = WaveBox::Wave;

/// Components that one potential ties together: each wave's field is `factor` times (-i direction, sign), all
/// times its amplitude.
struct Part {
  Array3d component;  ///< 1 for those that belong to it
  double vertical;    ///< sign of B_z
};

std::vector<Part> parts_of(SourceSide side) {
  if (side == SourceSide::kBelow) return {{{1, 1, 1}, 1.0}};
  if (side == SourceSide::kAbove) return {{{1, 1, 1}, -1.0}};
  return {{{1, 1, 0}, 1.0}, {{0, 0, 1}, 1.0}};
}

/// Component c of a wave's field where its phase is zero, for the complex amplitude 1.
Complex field_of(const Wave& wave, const Part& part, int c) {
  if (part.component(c) == 0.0) return 0.0;
  return c == 2 ? Complex(part.vertical * wave.amplitude, 0.0)
                : Complex(0.0, -wave.direction(c) * wave.amplitude);
}

/// Component c of the field of a long wave's unit amplitude: a factor of one column of long_waves_at(). First
/// the cosine amplitudes of all, then the sine amplitudes.
struct LongTerm {
  double factor;
  Index column;
};
LongTerm long_term(const WaveBox& box, const Part& part, Index unknown, int c) {
  const auto n = static_cast<Index>(box.long_waves.size());
  const Index l = unknown % n, cosine = l, sine = n + l;
  const bool of_cosine = unknown < n;
  const WaveBox::LongWave& wave = box.long_waves[static_cast<std::size_t>(l)];
  if (c == 2) return {part.component(c) * part.vertical * wave.amplitude, of_cosine ? cosine : sine};
  const double factor = part.component(c) * wave.amplitude * wave.direction(c);
  return of_cosine ? LongTerm{factor, sine} : LongTerm{-factor, cosine};
}

/// Component c of each long wave's unit amplitudes, where their columns are given.
MatrixXd long_fields(const WaveBox& box, const Part& part, int c, const MatrixXd& columns) {
  MatrixXd fields(columns.rows(), columns.cols());
  for (Index u = 0; u < fields.cols(); ++u) {
    const LongTerm term = long_term(box, part, u, c);
    fields.col(u) = term.factor * columns.col(term.column);
  }
  return fields;
}

/// Products of two waves' fields, weighted and summed over components: with and without conjugation of the
/// second. Both are real.
struct FieldProduct {
  double same, conjugate;
};
FieldProduct product_of(const Wave& i, const Wave& j, const Array3d& weights) {
  const double amplitudes = i.amplitude * j.amplitude;
  const double horizontal =
      weights(0) * i.direction.x() * j.direction.x() + weights(1) * i.direction.y() * j.direction.y();
  return {amplitudes * (weights(2) - horizontal), amplitudes * (weights(2) + horizontal)};
}

}  // namespace

struct HarmonicTile::State : WaveBox {
  using WaveBox::WaveBox;
};

/// One tile's tables and matrices; their memory serves the next tile.
struct HarmonicTile::Workspace::State {
  void sum(const WaveBox& box, std::span<const TileSample> samples);
  void sum_long_waves(const WaveBox& box, const VectorXd& w, const MatrixXd& readings);
  void solve(const WaveBox& box, const Part& part, const Array3d& information);
  void assemble_waves(const WaveBox& box, const Part& part, const Array3d& information);
  void assemble_long_waves(const WaveBox& box, const Part& part, const Array3d& information);
  void set_waves(const WaveBox& box, const Part& part, int c, const Eigen::Ref<const VectorXd>& unknowns);
  void add_long_variance(const WaveBox& box, const Part& part, int c, MatrixXd& variance);
  void mean(const WaveBox& box, const Part& part, Posterior& posterior);
  void variance(const WaveBox& box, const Part& part, Posterior& posterior);

  MatrixProduct product;
  SpdInverse inverse;
  Harmonics x, y;
  WaveTable weights;                    ///< summed over samples
  std::array<WaveTable, 3> values;      ///< the same times their values
  std::vector<WaveTable> long_sums;     ///< weights times each column of long waves, summed over samples
  MatrixXd long_products, long_values;  ///< the same columns times each other, and times the values
  std::vector<Index> near;              ///< the samples that are in tile and halo
  MatrixXd long_columns;                ///< long waves at them
  WaveTable at_cells;
  MatrixXd precision;  ///< unknowns: cosine and sine of each wave
  VectorXd rhs, solution;
  const MatrixXd* covariance = nullptr;
};

void HarmonicTile::Workspace::State::sum(const WaveBox& box, std::span<const TileSample> samples) {
  const double low = -box.halo_m, high = box.length_m + box.halo_m;
  near.clear();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Array2d p = samples[i].position_m.array();
    if ((p >= low).all() && (p <= high).all()) near.push_back(static_cast<Index>(i));
  }
  const auto n = static_cast<Index>(near.size());
  Eigen::MatrixX2d points_m(n, 2);
  VectorXd w(n);
  MatrixXd readings(n, 3);
  for (Index i = 0; i < n; ++i) {
    const TileSample& sample = samples[static_cast<std::size_t>(near[static_cast<std::size_t>(i)])];
    points_m.row(i) = sample.position_m.transpose();
    w(i) = sample.weight;
    readings.row(i) = sample.value.matrix().transpose();
  }
  x.evaluate(points_m.col(0), box.period_m, 2 * box.highest);
  y.evaluate(points_m.col(1), box.period_m, 2 * box.highest);
  sum_over_samples(x, y, w, 2 * box.highest, product, weights);
  for (int c = 0; c < 3; ++c)
    sum_over_samples(x, y, w.cwiseProduct(readings.col(c)), box.highest, product,
                     values[static_cast<std::size_t>(c)]);
  long_columns = long_waves_at(box, points_m);
  sum_long_waves(box, w, readings);
}

void HarmonicTile::Workspace::State::sum_long_waves(const WaveBox& box, const VectorXd& w,
                                                    const MatrixXd& readings) {
  const MatrixXd &columns = long_columns, weighted = w.asDiagonal() * columns;
  long_products.setZero(columns.cols(), columns.cols());
  product.add(columns.transpose(), weighted, long_products);
  long_values.setZero(columns.cols(), 3);
  product.add(weighted.transpose(), readings, long_values);
  long_sums.resize(static_cast<std::size_t>(columns.cols()));
  for (Index k = 0; k < columns.cols(); ++k)
    sum_over_samples(x, y, weighted.col(k), box.highest, product, long_sums[static_cast<std::size_t>(k)]);
}

void HarmonicTile::Workspace::State::assemble_waves(const WaveBox& box, const Part& part,
                                                    const Array3d& information) {
  const auto m = static_cast<Index>(box.waves.size());
  for (Index j = 0; j < m; ++j) {
    const Wave& wj = box.waves[static_cast<std::size_t>(j)];
    for (Index i = j; i < m; ++i) {
      const Wave& wi = box.waves[static_cast<std::size_t>(i)];
      const FieldProduct fields = product_of(wi, wj, information);
      const Complex same = 0.5 * fields.same * weights.at(wi.a + wj.a, wi.b + wj.b);
      const Complex conjugate = 0.5 * fields.conjugate * weights.at(wi.a - wj.a, wi.b - wj.b);
      precision(2 * i, 2 * j) = conjugate.real() + same.real();
      precision(2 * i, 2 * j + 1) = same.imag() - conjugate.imag();
      precision(2 * i + 1, 2 * j) = same.imag() + conjugate.imag();
      precision(2 * i + 1, 2 * j + 1) = conjugate.real() - same.real();
    }
    Complex sum = 0.0;
    for (int c = 0; c < 3; ++c)
      sum += information(c) * field_of(wj, part, c) * values[static_cast<std::size_t>(c)].at(wj.a, wj.b);
    rhs(2 * j) = sum.real();
    rhs(2 * j + 1) = sum.imag();
  }
}

/// Their rows come below those of the waves.
void HarmonicTile::Workspace::State::assemble_long_waves(const WaveBox& box, const Part& part,
                                                         const Array3d& information) {
  const auto first = static_cast<Index>(2 * box.waves.size());
  for (Index u = 0; first + u < precision.rows(); ++u)
    for (int c = 0; c < 3; ++c) {
      const LongTerm term = long_term(box, part, u, c);
      const double factor = information(c) * term.factor;
      if (factor == 0.0) continue;
      const WaveTable& sums = long_sums[static_cast<std::size_t>(term.column)];
      for (Index j = 0; 2 * j < first; ++j) {
        const Wave& wave = box.waves[static_cast<std::size_t>(j)];
        const Complex sum = factor * field_of(wave, part, c) * sums.at(wave.a, wave.b);
        precision(first + u, 2 * j) += sum.real();
        precision(first + u, 2 * j + 1) += sum.imag();
      }
      for (Index v = 0; v <= u; ++v) {
        const LongTerm other = long_term(box, part, v, c);
        precision(first + u, first + v) += factor * other.factor * long_products(term.column, other.column);
      }
      rhs(first + u) += factor * long_values(term.column, c);
    }
}

/// The normal equations of a Bayesian linear model with unit prior (R&W Eq. 2.8).
void HarmonicTile::Workspace::State::solve(const WaveBox& box, const Part& part, const Array3d& information) {
  const auto unknowns = static_cast<Index>(2 * (box.waves.size() + box.long_waves.size()));
  precision.setZero(unknowns, unknowns);
  rhs.setZero(unknowns);
  assemble_waves(box, part, information);
  assemble_long_waves(box, part, information);
  precision.diagonal().array() += 1.0;
  covariance =
      inverse.invert(std::move(precision));  // I + something positive: rounding alone cannot spoil it
  assert(covariance != nullptr);
  solution = *covariance * rhs;
}

void HarmonicTile::Workspace::State::set_waves(const WaveBox& box, const Part& part, int c,
                                               const Eigen::Ref<const VectorXd>& unknowns) {
  at_cells.set_zero(box.highest);
  for (std::size_t j = 0; j < box.waves.size(); ++j) {
    const auto at = static_cast<Index>(2 * j);
    const Wave& wave = box.waves[j];
    at_cells.add(wave.a, wave.b, Complex(unknowns(at), -unknowns(at + 1)) * field_of(wave, part, c));
  }
}

void HarmonicTile::Workspace::State::mean(const WaveBox& box, const Part& part, Posterior& posterior) {
  for (int c = 0; c < 3; ++c) {
    if (part.component(c) == 0.0) continue;
    MatrixXd& mean = posterior.mean[static_cast<std::size_t>(c)];
    set_waves(box, part, c, solution);
    evaluate_at_cells(at_cells, box.cell_harmonics, product, mean);
    const auto long_solution = solution.tail(static_cast<Index>(2 * box.long_waves.size()));
    mean.reshaped() += long_fields(box, part, c, box.long_waves_at_cells) * long_solution;
    VectorXd at_samples;
    evaluate_at_points(at_cells, x, y, product, at_samples);
    at_samples += long_fields(box, part, c, long_columns) * long_solution;
    for (std::size_t i = 0; i < near.size(); ++i)
      posterior.mean_at_samples(near[i], c) = at_samples(static_cast<Index>(i));
  }
}

/// A quadratic form of waves is a sum of waves whose numbers are sums and differences of theirs.
void HarmonicTile::Workspace::State::variance(const WaveBox& box, const Part& part, Posterior& posterior) {
  const MatrixXd& k = *covariance;
  for (int c = 0; c < 3; ++c) {
    if (part.component(c) == 0.0) continue;
    Array3d only = Array3d::Zero();
    only(c) = 1.0;
    at_cells.set_zero(2 * box.highest);
    for (std::size_t j = 0; j < box.waves.size(); ++j)
      for (std::size_t i = j; i < box.waves.size(); ++i) {
        const Wave &wi = box.waves[i], &wj = box.waves[j];
        const auto p = static_cast<Index>(2 * i), q = static_cast<Index>(2 * j);
        const FieldProduct fields = product_of(wi, wj, only);
        const double half = i == j ? 0.5 : 1.0;  // a pair stands for its mirror image too
        at_cells.add(wi.a + wj.a, wi.b + wj.b,
                     half * fields.same * Complex(k(p, q) - k(p + 1, q + 1), -(k(p, q + 1) + k(p + 1, q))));
        at_cells.add(
            wi.a - wj.a, wi.b - wj.b,
            half * fields.conjugate * Complex(k(p, q) + k(p + 1, q + 1), -(k(p + 1, q) - k(p, q + 1))));
      }
    MatrixXd& variance = posterior.variance[static_cast<std::size_t>(c)];
    evaluate_at_cells(at_cells, box.cell_harmonics, product, variance);
    add_long_variance(box, part, c, variance);
    variance = (variance.array() + box.left_out(c)).cwiseMax(0.0);
  }
}

/// Of the long waves, and what they share with the others.
void HarmonicTile::Workspace::State::add_long_variance(const WaveBox& box, const Part& part, int c,
                                                       MatrixXd& variance) {
  const auto first = static_cast<Index>(2 * box.waves.size()), n = covariance->rows() - first;
  const MatrixXd fields = long_fields(box, part, c, box.long_waves_at_cells);
  variance.reshaped() += (fields * covariance->bottomRightCorner(n, n)).cwiseProduct(fields).rowwise().sum();
  MatrixXd shared;
  for (Index u = 0; u < n; ++u) {
    set_waves(box, part, c, covariance->col(first + u).head(first));
    evaluate_at_cells(at_cells, box.cell_harmonics, product, shared);
    variance.reshaped() += 2.0 * shared.reshaped().cwiseProduct(fields.col(u));
  }
}

HarmonicTile::HarmonicTile(const HarmonicTileOptions& options, const HarmonicFineness& fineness)
    : state_(std::make_unique<const State>(options, fineness)) {
  assert(options.field.depth_m > 0 && options.field.signal_sd_uT > 0 && options.cell_m > 0);
}
HarmonicTile::HarmonicTile(HarmonicTile&&) noexcept = default;
HarmonicTile::~HarmonicTile() = default;

HarmonicTile::Workspace::Workspace() : state_(std::make_unique<State>()) {}
HarmonicTile::Workspace::Workspace(Workspace&&) noexcept = default;
HarmonicTile::Workspace& HarmonicTile::Workspace::operator=(Workspace&&) noexcept = default;
HarmonicTile::Workspace::~Workspace() = default;

int HarmonicTile::cells() const { return state_->cells; }
double HarmonicTile::halo_m() const { return state_->halo_m; }
int HarmonicTile::rank() const { return static_cast<int>(2 * state_->waves.size()); }

HarmonicTile::Posterior HarmonicTile::solve(std::span<const TileSample> samples, Workspace& workspace) const {
  Workspace::State& work = *workspace.state_;
  work.sum(*state_, samples);
  const HarmonicHyperparameters& h = state_->options.field;
  const Array3d information = (h.signal_sd_uT / h.noise_sd_uT).square();
  Posterior posterior;
  posterior.mean_at_samples.setZero(static_cast<Index>(samples.size()), 3);
  for (const Part& part : parts_of(h.side)) {
    work.solve(*state_, part, information * part.component);
    work.mean(*state_, part, posterior);
    work.variance(*state_, part, posterior);
  }
  return posterior;
}

// Measured against the dense solution under sheets of poles (the tests hold it there).
HarmonicFineness harmonic_fineness(RegressionQuality quality) {
  if (quality == RegressionQuality::kExact) return {3.0, 2.5, 2.0, 0.02};
  return {2.0, 1.25, 0.75, 0.2};
}

}  // namespace mstsl
