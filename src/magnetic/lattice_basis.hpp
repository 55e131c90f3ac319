#pragma once

#include <array>

#include <Eigen/Core>

namespace mstsl {

/// Where a point falls on a line of equidistant nodes: the weights that interpolate a smooth function from 12
/// of them, or, transposed, spread a sample to them so that sums over polynomials up to degree 11 stay what
/// they were.
struct LagrangeStencil {
  static constexpr int kSize = 12;
  int first = 0;
  std::array<double, kSize> weights{};
};

struct LatticeBasisOptions {
  double length_m = 0.0;        ///< of the tile; it lies at 0 .. length_m
  double halo_m = 0.0;          ///< on both sides of it
  double length_scale_m = 1.0;  ///< of the covariance
  double node_spacing_m = 0.1;
  /// How fast the attention of the factorisation fades outside the tile: exp(-fading * distance^1.5), in
  /// length scales.
  double fading = 1.0;
  double tolerance = 1e-7;  ///< eigenvalues below this share of the largest are left out
};

/// One axis of the separable covariance exp(-d^2 / 2 l^2), factorised on nodes over a tile and its halo: the
/// covariance of nodes i and j is close to values.row(i) * values.row(j), and closest in the tile.
class LatticeBasis {
 public:
  explicit LatticeBasis(const LatticeBasisOptions& options);

  int nodes() const { return static_cast<int>(values_.rows()); }
  int rank() const { return static_cast<int>(values_.cols()); }
  /// Basis functions at the nodes, nodes x rank, most important first.
  const Eigen::MatrixXd& values() const { return values_; }
  /// How important each is, the first 1.
  const Eigen::VectorXd& importance() const { return importance_; }

  /// Expects a point within the tile and halo.
  LagrangeStencil stencil(double position_m) const;
  /// Basis functions at a point, 1 x rank.
  Eigen::RowVectorXd at(double position_m) const;

 private:
  double first_node_m_;
  double spacing_m_;
  Eigen::MatrixXd values_;
  Eigen::VectorXd importance_;
};

}  // namespace mstsl
