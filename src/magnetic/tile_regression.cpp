#include "mstsl/magnetic/tile_regression.hpp"

#include <cassert>
#include <vector>

#include "dense/spd_inverse.hpp"
#include "tile_basis.hpp"

namespace mstsl {

using Eigen::Index;
using Eigen::MatrixXd;

struct TileRegression::State : TileBasis {
  using TileBasis::TileBasis;
};

/// One tile's matrices; their memory serves the next tile.
struct TileRegression::Workspace::State {
  void spread(const TileBasis& basis, std::span<const TileSample> samples);
  void solve_modes(const TileBasis& basis);
  /// The modes' coefficients for one field.
  MatrixXd coefficients(const TileBasis& basis, const MatrixXd& weighted) const;
  void variance(const TileBasis& basis, MatrixXd& variance);

  MatrixProduct product;
  SpdInverse inverse;
  MatrixXd information;              ///< one over noise variance, summed, nodes x nodes
  std::array<MatrixXd, 3> weighted;  ///< the same times the values
  MatrixXd by_pairs;                 ///< pairs x pairs
  MatrixXd half;                     ///< of a product of three factors
  MatrixXd precision;                ///< modes x modes
  const MatrixXd* covariance = nullptr;
};

/// Sums over the samples of any smooth function become sums over the nodes.
void TileRegression::Workspace::State::spread(const TileBasis& basis, std::span<const TileSample> samples) {
  const int n = basis.axis.nodes();
  information.setZero(n, n);
  for (MatrixXd& values : weighted) values.setZero(n, n);
  const double halo_m = basis.fine.halo * basis.options.length_scale_m;
  const double low = -halo_m, high = basis.cells * basis.options.cell_m + halo_m;
  constexpr int kSize = LagrangeStencil::kSize;
  for (const TileSample& sample : samples) {
    const Eigen::Vector2d& p = sample.position_m;
    if (p.x() < low || p.y() < low || p.x() > high || p.y() > high) continue;
    const LagrangeStencil sx = basis.axis.stencil(p.x());
    const LagrangeStencil sy = basis.axis.stencil(p.y());
    const Eigen::Map<const Eigen::Vector<double, kSize>> wx(sx.weights.data());
    for (int j = 0; j < kSize; ++j) {
      const double wy = sample.weight * sy.weights[static_cast<std::size_t>(j)];
      information.col(sy.first + j).segment<kSize>(sx.first) += wy * wx;
      for (std::size_t c = 0; c < 3; ++c)
        weighted[c].col(sy.first + j).segment<kSize>(sx.first) += wy * sample.value[c] * wx;
    }
  }
  information.array() /= basis.node_noise.array();
  for (MatrixXd& values : weighted) values.array() /= basis.node_noise.array();
}

/// covariance = (I + Phi^T N^-1 Phi)^-1 over the modes (R&W Eq. 2.11 with the prior scaled to the identity).
void TileRegression::Workspace::State::solve_modes(const TileBasis& basis) {
  half.setZero(basis.pairs.size(), information.cols());
  product.add(basis.node_pairs, information, half);
  by_pairs.setZero(basis.pairs.size(), basis.pairs.size());
  product.add(half, basis.node_pairs.transpose(), by_pairs);
  const auto& modes = basis.modes;
  const auto m = static_cast<Index>(modes.size());
  precision.resize(m, m);
  for (Index b = 0; b < m; ++b) {
    for (Index a = b; a < m; ++a)
      precision(a, b) = by_pairs(basis.pairs(modes[a].x, modes[b].x), basis.pairs(modes[a].y, modes[b].y));
    precision(b, b) += 1.0;
  }
  // Spreading leaves tiny negative weights at the edge of the data; should they ever win, a stronger prior
  // outweighs them, and at the worst nothing is known here.
  for (double prior = 0.0; (covariance = inverse(precision)) == nullptr; prior = std::max(2 * prior, 1e-3)) {
    precision.diagonal().array() += prior;
    if (prior > 1.0) precision.setIdentity();
    if (prior > 1.0)
      for (MatrixXd& values : weighted) values.setZero();
  }
}

MatrixXd TileRegression::Workspace::State::coefficients(const TileBasis& basis,
                                                        const MatrixXd& weighted_values) const {
  const MatrixXd by_axes = basis.axis.values().transpose() * weighted_values * basis.axis.values();
  const auto m = static_cast<Index>(basis.modes.size());
  Eigen::VectorXd rhs(m);
  for (Index i = 0; i < m; ++i) rhs(i) = by_axes(basis.modes[i].x, basis.modes[i].y);
  const Eigen::VectorXd solution = *covariance * rhs;
  MatrixXd coefficients = MatrixXd::Zero(basis.axis.rank(), basis.axis.rank());
  for (Index i = 0; i < m; ++i) coefficients(basis.modes[i].x, basis.modes[i].y) = solution(i);
  return coefficients;
}

/// The diagonal of Phi C Phi^T at all cells, plus what the modes leave out.
void TileRegression::Workspace::State::variance(const TileBasis& basis, MatrixXd& variance) {
  by_pairs.setZero(basis.pairs.size(), basis.pairs.size());
  const auto& modes = basis.modes;
  for (Index b = 0; b < covariance->cols(); ++b)
    for (Index a = b; a < covariance->rows(); ++a)
      by_pairs(basis.pairs(modes[a].x, modes[b].x), basis.pairs(modes[a].y, modes[b].y)) +=
          (a == b ? 1.0 : 2.0) * (*covariance)(a, b);
  half.setZero(basis.cells, basis.pairs.size());
  product.add(basis.cell_pairs.transpose(), by_pairs, half);
  variance = basis.cell_left_out;
  product.add(half, basis.cell_pairs, variance);
  variance = variance.cwiseMax(0.0);
}

namespace {

Eigen::MatrixX3d mean_at(const TileBasis& basis, const std::array<MatrixXd, 3>& coefficients,
                         std::span<const TileSample> samples) {
  Eigen::MatrixX3d mean = Eigen::MatrixX3d::Zero(static_cast<Index>(samples.size()), 3);
  const double side_m = basis.cells * basis.options.cell_m;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Array2d p = samples[i].position_m.array();
    if (!(p >= 0.0).all() || !(p <= side_m).all()) continue;
    const Eigen::RowVectorXd x = basis.axis.at(p.x()), y = basis.axis.at(p.y());
    for (std::size_t c = 0; c < 3; ++c)
      mean(static_cast<Index>(i), static_cast<Index>(c)) = x * coefficients[c] * y.transpose();
  }
  return mean;
}

}  // namespace

TileRegression::TileRegression(const TileOptions& options) : state_(std::make_unique<const State>(options)) {
  assert(options.length_scale_m > 0 && options.cell_m > 0 && options.noise_ratio >= kMinNoiseRatio);
}
TileRegression::TileRegression(TileRegression&&) noexcept = default;
TileRegression::~TileRegression() = default;

TileRegression::Workspace::Workspace() : state_(std::make_unique<State>()) {}
TileRegression::Workspace::Workspace(Workspace&&) noexcept = default;
TileRegression::Workspace& TileRegression::Workspace::operator=(Workspace&&) noexcept = default;
TileRegression::Workspace::~Workspace() = default;

int TileRegression::cells() const { return state_->cells; }
double TileRegression::halo_m() const { return state_->fine.halo * state_->options.length_scale_m; }
int TileRegression::rank() const { return static_cast<int>(state_->modes.size()); }

TileRegression::Posterior TileRegression::solve(std::span<const TileSample> samples,
                                                Workspace& workspace) const {
  Workspace::State& work = *workspace.state_;
  work.spread(*state_, samples);
  work.solve_modes(*state_);
  Posterior posterior;
  std::array<MatrixXd, 3> coefficients;
  for (std::size_t c = 0; c < 3; ++c) {
    coefficients[c] = work.coefficients(*state_, work.weighted[c]);
    posterior.mean[c] = state_->cell_values * coefficients[c] * state_->cell_values.transpose();
  }
  posterior.mean_at_samples = mean_at(*state_, coefficients, samples);
  work.variance(*state_, posterior.variance);
  return posterior;
}

}  // namespace mstsl
