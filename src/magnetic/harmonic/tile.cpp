#include "tile.hpp"

#include <cassert>
#include <complex>

#include "sample_sums.hpp"
#include "wave_fields.hpp"
#include "wave_system.hpp"

namespace mstsl {

using Complex = std::complex<double>;
using Eigen::Array3d;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Wave = WaveBox::Wave;

struct HarmonicTile::State : WaveBox {
  using WaveBox::WaveBox;
};

/// One tile's tables and matrices; their memory serves the next tile.
struct HarmonicTile::Workspace::State {
  void set_waves(const WaveBox& box, const PotentialPart& part, int c,
                 const Eigen::Ref<const VectorXd>& unknowns);
  void add_long_variance(const WaveBox& box, const PotentialPart& part, int c, MatrixXd& variance);
  void mean(const WaveBox& box, const PotentialPart& part, Posterior& posterior);
  void variance(const WaveBox& box, const PotentialPart& part, Posterior& posterior);

  MatrixProduct product;
  SampleSums sums;
  WaveSystem system;
  WaveTable at_cells;
};

void HarmonicTile::Workspace::State::set_waves(const WaveBox& box, const PotentialPart& part, int c,
                                               const Eigen::Ref<const VectorXd>& unknowns) {
  at_cells.set_zero(box.highest);
  for (std::size_t j = 0; j < box.waves.size(); ++j) {
    const auto at = static_cast<Index>(2 * j);
    const Wave& wave = box.waves[j];
    at_cells.add(wave.a, wave.b, Complex(unknowns(at), -unknowns(at + 1)) * field_of(wave, part, c));
  }
}

void HarmonicTile::Workspace::State::mean(const WaveBox& box, const PotentialPart& part,
                                          Posterior& posterior) {
  for (int c = 0; c < 3; ++c) {
    if (part.component(c) == 0.0) continue;
    MatrixXd& mean = posterior.mean[static_cast<std::size_t>(c)];
    set_waves(box, part, c, system.solution());
    evaluate_at_cells(at_cells, box.cell_harmonics, product, mean);
    const auto long_solution = system.solution().tail(static_cast<Index>(2 * box.long_waves.size()));
    mean.reshaped() += long_fields(box, part, c, box.long_waves_at_cells) * long_solution;
    VectorXd at_samples;
    evaluate_at_points(at_cells, sums.x, sums.y, product, at_samples);
    at_samples += long_fields(box, part, c, sums.long_columns) * long_solution;
    for (std::size_t i = 0; i < sums.near.size(); ++i)
      posterior.mean_at_samples(sums.near[i], c) = at_samples(static_cast<Index>(i));
  }
}

/// A quadratic form of waves is a sum of waves whose numbers are sums and differences of theirs.
void HarmonicTile::Workspace::State::variance(const WaveBox& box, const PotentialPart& part,
                                              Posterior& posterior) {
  const MatrixXd& k = system.covariance();
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
void HarmonicTile::Workspace::State::add_long_variance(const WaveBox& box, const PotentialPart& part, int c,
                                                       MatrixXd& variance) {
  const auto first = static_cast<Index>(2 * box.waves.size()), n = system.covariance().rows() - first;
  const MatrixXd fields = long_fields(box, part, c, box.long_waves_at_cells);
  variance.reshaped() +=
      (fields * system.covariance().bottomRightCorner(n, n)).cwiseProduct(fields).rowwise().sum();
  MatrixXd shared;
  for (Index u = 0; u < n; ++u) {
    set_waves(box, part, c, system.covariance().col(first + u).head(first));
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
  work.sums.sum(*state_, samples, work.product);
  const HarmonicHyperparameters& h = state_->options.field;
  const Array3d information = (h.signal_sd_uT / h.noise_sd_uT).square();
  Posterior posterior;
  posterior.mean_at_samples.setZero(static_cast<Index>(samples.size()), 3);
  for (const PotentialPart& part : parts_of(h.side)) {
    work.system.solve(*state_, part, information * part.component, work.sums);
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
