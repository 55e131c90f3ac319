#include "lattice_basis.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace mstsl {
namespace {

/// How much the factorisation cares about a node `distance` length scales outside the tile. Of the forms
/// exp(-b d^p) the power 1.5 reaches a given error of the tile's mean with the smallest rank (measured, 1 to
/// 2).
double attention(double distance, double fading) {
  return distance <= 0.0 ? 1.0 : std::exp(-fading * distance * std::sqrt(distance));
}

/// One over the product of (i - j) over all j but i.
constexpr auto kLagrangeFactors = [] {
  constexpr int kSize = LagrangeStencil::kSize;
  std::array<double, kSize> factors{};
  for (int i = 0; i < kSize; ++i) {
    double product = 1.0;
    for (int j = 0; j < kSize; ++j)
      if (j != i) product *= i - j;
    factors[static_cast<std::size_t>(i)] = 1.0 / product;
  }
  return factors;
}();

}  // namespace

LatticeBasis::LatticeBasis(const LatticeBasisOptions& o) : spacing_m_(o.node_spacing_m) {
  const int margin = LagrangeStencil::kSize / 2;  // so that every stencil is centred
  const int n = static_cast<int>(std::ceil((o.length_m + 2 * o.halo_m) / spacing_m_)) + 1 + 2 * margin;
  first_node_m_ = -o.halo_m - margin * spacing_m_;
  Eigen::VectorXd root_attention(n);
  for (int i = 0; i < n; ++i) {
    const double x_m = first_node_m_ + i * spacing_m_;
    root_attention(i) = std::sqrt(attention(std::max(-x_m, x_m - o.length_m) / o.length_scale_m, o.fading));
  }
  Eigen::MatrixXd k(n, n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double d = (i - j) * spacing_m_ / o.length_scale_m;
      k(i, j) = std::exp(-0.5 * d * d) * root_attention(i) * root_attention(j);
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k);
  const Eigen::VectorXd lambda = eigen.eigenvalues().reverse();
  const int rank = static_cast<int>((lambda.array() > o.tolerance * lambda(0)).count());
  importance_ = lambda.head(rank) / lambda(0);
  values_ = root_attention.cwiseInverse().asDiagonal() *
            eigen.eigenvectors().rowwise().reverse().leftCols(rank) *
            lambda.head(rank).cwiseSqrt().asDiagonal();
}

LagrangeStencil LatticeBasis::stencil(double position_m) const {
  constexpr int kSize = LagrangeStencil::kSize;
  const double t = (position_m - first_node_m_) / spacing_m_;
  LagrangeStencil s;
  s.first = std::clamp(static_cast<int>(std::floor(t)) - kSize / 2 + 1, 0, nodes() - kSize);
  // Weight i is the product of (u - j) over all j but i, over its value at u = i.
  const double u = t - s.first;
  double product = 1.0;
  for (std::size_t i = 0; i < kSize; ++i) {
    s.weights[i] = kLagrangeFactors[i] * product;
    product *= u - static_cast<double>(i);
  }
  product = 1.0;
  for (std::size_t i = kSize; i-- > 0;) {
    s.weights[i] *= product;
    product *= u - static_cast<double>(i);
  }
  return s;
}

Eigen::RowVectorXd LatticeBasis::at(double position_m) const {
  const LagrangeStencil s = stencil(position_m);
  return Eigen::Map<const Eigen::RowVectorXd>(s.weights.data(), LagrangeStencil::kSize) *
         values_.middleRows(s.first, LagrangeStencil::kSize);
}

}  // namespace mstsl
