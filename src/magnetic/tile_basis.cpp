#include "tile_basis.hpp"

namespace mstsl {
namespace {

using Eigen::MatrixXd;

/// values.col(a) * values.col(b) for each pair a <= b, pairs x rows.
MatrixXd pair_products(const MatrixXd& values, const Pairs& pairs) {
  MatrixXd products(pairs.size(), values.rows());
  for (int b = 0; b < pairs.rank; ++b)
    for (int a = 0; a <= b; ++a)
      products.row(pairs(a, b)) = values.col(a).cwiseProduct(values.col(b)).transpose();
  return products;
}

LatticeBasis make_axis(const TileOptions& o, const TileFineness& fine) {
  return LatticeBasis({tile_cells(o) * o.cell_m, fine.halo * o.length_scale_m, o.length_scale_m,
                       fine.spacing * o.length_scale_m, fine.fading, fine.tolerance});
}

}  // namespace

TileBasis::TileBasis(const TileOptions& o)
    : options(o),
      fine(o),
      cells(tile_cells(o)),
      axis(make_axis(o, fine)),
      pairs(axis.rank()),
      keep(MatrixXd::Zero(axis.rank(), axis.rank())),
      node_pairs(pair_products(axis.values(), pairs)),
      cell_values(cells, axis.rank()) {
  for (int j = 0; j < axis.rank(); ++j)
    for (int i = 0; i < axis.rank(); ++i)
      if (axis.importance()(i) * axis.importance()(j) > fine.tolerance) {
        modes.push_back({i, j});
        keep(i, j) = 1.0;
      }
  for (int i = 0; i < cells; ++i) cell_values.row(i) = axis.at((i + 0.5) * o.cell_m);
  cell_pairs = pair_products(cell_values, pairs);
  node_noise = fine.noise_ratio * fine.noise_ratio + left_out(axis.values()).array();
  cell_left_out = left_out(cell_values);
}

MatrixXd TileBasis::left_out(const MatrixXd& values) const {
  const MatrixXd squares = values.cwiseAbs2();
  return (1.0 - (squares * keep * squares.transpose()).array()).cwiseMax(0.0);
}

}  // namespace mstsl
