#pragma once

#include <vector>

#include "lattice_basis.hpp"
#include "tile_fineness.hpp"

namespace mstsl {

/// Products of two basis functions of one axis, by the unordered pair.
struct Pairs {
  explicit Pairs(int functions) : rank(functions) {}
  int rank;
  Eigen::Index size() const { return static_cast<Eigen::Index>(rank) * (rank + 1) / 2; }
  Eigen::Index operator()(int a, int b) const {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<Eigen::Index>(high) * (high + 1) / 2 + low;
  }
};

/// What every tile of a map shares: the modes, products of a function of x and a function of y, and their
/// values at the nodes and the cells.
struct TileBasis {
  explicit TileBasis(const TileOptions& options);

  /// The part of the prior variance that the kept modes do not cover, at the points whose values are given.
  Eigen::MatrixXd left_out(const Eigen::MatrixXd& values) const;

  struct Mode {
    int x, y;
  };
  TileOptions options;
  TileFineness fine;
  int cells;
  LatticeBasis axis;
  Pairs pairs;
  std::vector<Mode> modes;
  Eigen::MatrixXd keep;           ///< rank x rank, 1 for the modes
  Eigen::MatrixXd node_pairs;     ///< pairs x nodes
  Eigen::MatrixXd cell_values;    ///< cells x rank
  Eigen::MatrixXd cell_pairs;     ///< pairs x cells
  Eigen::MatrixXd node_noise;     ///< noise variance of a sample at a node, nodes x nodes
  Eigen::MatrixXd cell_left_out;  ///< cells x cells
};

}  // namespace mstsl
