#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/magnetic/fingerprint.hpp"

namespace mstsl {

/// Our reading of the paper's "bilinear interpolation": the fingerprints are gathered into a square lattice
/// as wide as the lanes are apart (each node the mean of the fingerprints around it, weighted by a tent that
/// falls to 0 at the next node), and the field between four nodes is bilinear. Nodes without a fingerprint
/// take the mean of their neighbours that have one, so that a single lane has a border.
class BilinearLattice {
 public:
  /// Positions in the frame along whose axes the lattice lies.
  BilinearLattice(std::span<const Eigen::Vector2d> positions_m, std::span<const Fingerprint> fingerprints,
                  double spacing_m);

  /// Nothing where one of the four nodes around has no value.
  std::optional<Eigen::Vector3d> at(const Eigen::Vector2d& position_m) const;

 private:
  struct Node {
    long row = 0, column = 0;
    double weight = 0.0;
    Eigen::Vector3d sum_uT = Eigen::Vector3d::Zero();
  };
  const Node* find(long row, long column) const;
  void merge(std::vector<Node> nodes);
  void fill_border();

  double spacing_m_;
  std::vector<Node> nodes_;  ///< by row, then column
};

/// How far apart parallel lanes lie: the median distance to the next fingerprint at the side (not on the same
/// line); 0.5 m where there is none.
double lane_spacing_m(std::span<const Fingerprint> fingerprints);

}  // namespace mstsl
