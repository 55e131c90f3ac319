#include "mstsl/magnetic/tile_regression.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <vector>

#include "lattice_basis.hpp"
#include "spd_inverse.hpp"

namespace mstsl {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Side of a tile, in length scales: a larger one has a larger rank, a smaller one more halo for its area.
constexpr double kTileSide = 6.0;

/// Products of two basis functions of one axis, by the unordered pair.
struct Pairs {
  explicit Pairs(int functions) : rank(functions) {}
  int rank;
  Index size() const { return static_cast<Index>(rank) * (rank + 1) / 2; }
  Index operator()(int a, int b) const {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<Index>(high) * (high + 1) / 2 + low;
  }
};

/// values.col(a) * values.col(b) for each pair a <= b, pairs x rows.
MatrixXd pair_products(const MatrixXd& values, const Pairs& pairs) {
  MatrixXd products(pairs.size(), values.rows());
  for (int b = 0; b < pairs.rank; ++b)
    for (int a = 0; a <= b; ++a)
      products.row(pairs(a, b)) = values.col(a).cwiseProduct(values.col(b)).transpose();
  return products;
}

int tile_cells(const TileOptions& o) {
  return o.cells > 0 ? o.cells
                     : std::max(4, static_cast<int>(std::lround(kTileSide * o.length_scale_m / o.cell_m)));
}

/// How finely a tile is worked on. The constants were fitted against the exact solution, over lanes 0.3 to 4
/// length scales apart and noise ratios 0.01 to 1 (the tests hold them there).
struct Fineness {
  explicit Fineness(const TileOptions& o) {
    const bool exact = o.quality == RegressionQuality::kExact;
    const double l2 = o.length_scale_m * o.length_scale_m;
    const double information = std::max(1.0, o.samples_per_m2 * l2 / (o.noise_ratio * o.noise_ratio));
    tolerance = std::clamp((exact ? 8e-5 : 7e-4) / information, 1e-12, 1e-5);
    fading = (exact ? 0.7 : 0.9) * std::pow(information / 2000.0, -0.075);
    halo = std::pow(13.0 / fading, 2.0 / 3.0);
    spacing = std::clamp((exact ? 0.16 : 0.2) * std::pow(o.noise_ratio / 0.08, 0.25), 0.08, 0.2);
  }
  double tolerance, fading;
  double halo, spacing;  ///< in length scales
};

LatticeBasis make_axis(const TileOptions& o, const Fineness& fine) {
  return LatticeBasis({tile_cells(o) * o.cell_m, fine.halo * o.length_scale_m, o.length_scale_m,
                       fine.spacing * o.length_scale_m, fine.fading, fine.tolerance});
}

/// The samples as seen from the nodes.
struct Spread {
  MatrixXd information;                     ///< one over noise variance, summed, nodes x nodes
  std::array<MatrixXd, 3> weighted_values;  ///< the same times the values
};

}  // namespace

struct TileRegression::State {
  explicit State(const TileOptions& o)
      : options(o),
        fine(o),
        cells(tile_cells(o)),
        axis(make_axis(o, fine)),
        pairs(axis.rank()),
        node_pairs(pair_products(axis.values(), pairs)) {
    keep = MatrixXd::Zero(axis.rank(), axis.rank());
    for (int j = 0; j < axis.rank(); ++j)
      for (int i = 0; i < axis.rank(); ++i)
        if (axis.importance()(i) * axis.importance()(j) > fine.tolerance) {
          modes.push_back({i, j});
          keep(i, j) = 1.0;
        }
    cell_values.resize(cells, axis.rank());
    for (int i = 0; i < cells; ++i) cell_values.row(i) = axis.at((i + 0.5) * o.cell_m);
    cell_pairs = pair_products(cell_values, pairs);
    node_noise = o.noise_ratio * o.noise_ratio + left_out(axis.values()).array();
    cell_left_out = left_out(cell_values);
  }

  Spread spread(std::span<const TileSample> samples, double halo_m) const;
  MatrixXd mode_covariance(const MatrixXd& information) const;
  MatrixXd mean(const MatrixXd& covariance, const MatrixXd& weighted_values) const;
  MatrixXd variance(const MatrixXd& covariance) const;

  /// The part of the prior variance that the kept modes do not cover, at the points whose values are given.
  MatrixXd left_out(const MatrixXd& values) const {
    const MatrixXd squares = values.cwiseAbs2();
    return (1.0 - (squares * keep * squares.transpose()).array()).cwiseMax(0.0);
  }

  struct Mode {
    int x, y;
  };
  TileOptions options;
  Fineness fine;
  int cells;
  LatticeBasis axis;
  Pairs pairs;
  MatrixXd node_pairs;  ///< pairs x nodes
  std::vector<Mode> modes;
  MatrixXd keep;           ///< rank x rank, 1 for the modes
  MatrixXd cell_values;    ///< cells x rank
  MatrixXd cell_pairs;     ///< pairs x cells
  MatrixXd node_noise;     ///< noise variance of a sample at a node, nodes x nodes
  MatrixXd cell_left_out;  ///< cells x cells
};

/// Sums over the samples of any smooth function become sums over the nodes.
Spread TileRegression::State::spread(std::span<const TileSample> samples, double halo_m) const {
  const int n = axis.nodes();
  Spread data{MatrixXd::Zero(n, n), {MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), MatrixXd::Zero(n, n)}};
  const double low = -halo_m, high = cells * options.cell_m + halo_m;
  constexpr int kSize = LagrangeStencil::kSize;
  for (const TileSample& sample : samples) {
    const Eigen::Vector2d& p = sample.position_m;
    if (p.x() < low || p.y() < low || p.x() > high || p.y() > high) continue;
    const LagrangeStencil sx = axis.stencil(p.x());
    const LagrangeStencil sy = axis.stencil(p.y());
    const Eigen::Map<const Eigen::Vector<double, kSize>> wx(sx.weights.data());
    for (int j = 0; j < kSize; ++j) {
      const double wy = sample.weight * sy.weights[static_cast<std::size_t>(j)];
      data.information.col(sy.first + j).segment<kSize>(sx.first) += wy * wx;
      for (std::size_t c = 0; c < 3; ++c)
        data.weighted_values[c].col(sy.first + j).segment<kSize>(sx.first) += wy * sample.value[c] * wx;
    }
  }
  data.information.array() /= node_noise.array();
  for (MatrixXd& values : data.weighted_values) values.array() /= node_noise.array();
  return data;
}

/// (I + Phi^T N^-1 Phi)^-1 over the modes (R&W Eq. 2.11 with the prior scaled to the identity).
MatrixXd TileRegression::State::mode_covariance(const MatrixXd& information) const {
  const MatrixXd half = node_pairs * information;
  const MatrixXd sums = half * node_pairs.transpose();
  const auto m = static_cast<Index>(modes.size());
  MatrixXd precision(m, m);
  for (Index b = 0; b < m; ++b) {
    for (Index a = b; a < m; ++a)
      precision(a, b) = sums(pairs(modes[a].x, modes[b].x), pairs(modes[a].y, modes[b].y));
    precision(b, b) += 1.0;
  }
  // Spreading may leave tiny negative weights at the edge of the data; a stronger prior outweighs them.
  for (double prior = 0.0; prior < 1.0; prior = std::max(2 * prior, 1e-3)) {
    precision.diagonal().array() += prior;
    if (auto inverse = spd_inverse(precision)) return std::move(*inverse);
  }
  return MatrixXd::Identity(m, m);
}

MatrixXd TileRegression::State::mean(const MatrixXd& covariance, const MatrixXd& weighted_values) const {
  const MatrixXd by_axes = axis.values().transpose() * weighted_values * axis.values();
  Eigen::VectorXd rhs(covariance.rows());
  for (Index m = 0; m < rhs.size(); ++m) rhs(m) = by_axes(modes[m].x, modes[m].y);
  const Eigen::VectorXd solution = covariance * rhs;
  MatrixXd coefficients = MatrixXd::Zero(axis.rank(), axis.rank());
  for (Index m = 0; m < rhs.size(); ++m) coefficients(modes[m].x, modes[m].y) = solution(m);
  return cell_values * coefficients * cell_values.transpose();
}

/// The diagonal of Phi C Phi^T at all cells, plus what the modes leave out.
MatrixXd TileRegression::State::variance(const MatrixXd& covariance) const {
  MatrixXd by_pairs = MatrixXd::Zero(pairs.size(), pairs.size());
  for (Index b = 0; b < covariance.cols(); ++b)
    for (Index a = b; a < covariance.rows(); ++a)
      by_pairs(pairs(modes[a].x, modes[b].x), pairs(modes[a].y, modes[b].y)) +=
          (a == b ? 1.0 : 2.0) * covariance(a, b);
  const MatrixXd half = cell_pairs.transpose() * by_pairs;
  return (half * cell_pairs + cell_left_out).cwiseMax(0.0);
}

TileRegression::TileRegression(const TileOptions& options) : state_(std::make_unique<const State>(options)) {
  assert(options.length_scale_m > 0 && options.cell_m > 0 && options.noise_ratio >= kMinNoiseRatio);
}
TileRegression::TileRegression(TileRegression&&) noexcept = default;
TileRegression::~TileRegression() = default;

int TileRegression::cells() const { return state_->cells; }
double TileRegression::halo_m() const { return state_->fine.halo * state_->options.length_scale_m; }
int TileRegression::rank() const { return static_cast<int>(state_->modes.size()); }

TileRegression::Posterior TileRegression::solve(std::span<const TileSample> samples) const {
  const Spread data = state_->spread(samples, halo_m());
  const MatrixXd covariance = state_->mode_covariance(data.information);
  Posterior posterior;
  for (std::size_t c = 0; c < 3; ++c) posterior.mean[c] = state_->mean(covariance, data.weighted_values[c]);
  posterior.variance = state_->variance(covariance);
  return posterior;
}

}  // namespace mstsl
