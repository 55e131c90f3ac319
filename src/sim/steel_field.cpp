#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "mstsl/sim/steel.hpp"

namespace mstsl::sim {
namespace {

/// A node is taken as one dipole from this many times its radius on; the first neglected term falls with the
/// cube.
constexpr double kOpening = 5.0;
/// Nodes of so few pairs are not split: opening one costs as much as summing them.
constexpr std::size_t kLeaf = 8;

Eigen::Vector3d middle_m(const PolePair& pair) { return 0.5 * (pair.positive_m + pair.negative_m); }

Eigen::Vector3d moment_uTm3(const PolePair& pair) {
  return pair.strength_uTm2 * (pair.positive_m - pair.negative_m);
}

/// Field of a point dipole at the offset r from it, in uT for a moment in uT m^3.
Eigen::Vector3d dipole_field(const Eigen::Vector3d& moment, const Eigen::Vector3d& r, double squared) {
  const double inverse_cube = 1.0 / (squared * std::sqrt(squared));
  return inverse_cube * (3.0 * moment.dot(r) / squared * r - moment);
}

/// Sorts, along the axis of the greatest spread.
void halve(std::vector<PolePair>& pairs, std::size_t first, std::size_t last) {
  Eigen::Vector3d low = middle_m(pairs[first]), high = low;
  for (std::size_t i = first; i < last; ++i) {
    low = low.cwiseMin(middle_m(pairs[i]));
    high = high.cwiseMax(middle_m(pairs[i]));
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const auto at = [&](std::size_t i) { return std::next(pairs.begin(), static_cast<std::ptrdiff_t>(i)); };
  // Stable: the order of summation, and with it the last bit of the field, is the same with every standard
  // library.
  std::stable_sort(at(first), at(last), [axis](const PolePair& p, const PolePair& q) {
    return middle_m(p)[axis] < middle_m(q)[axis];
  });
}

}  // namespace

SteelField::SteelField(const EarthField& earth, std::vector<PolePair> pairs)
    : earth_(earth), background_uT_(earth.in_map_uT()), pairs_(std::move(pairs)) {
  if (!pairs_.empty()) build(0, pairs_.size());
  charges_.resize(2 * static_cast<Eigen::Index>(pairs_.size()), 4);
  Eigen::Index row = 0;
  for (const PolePair& pair : pairs_) {
    charges_.row(row++) << pair.positive_m.transpose().array(), pair.strength_uTm2;
    charges_.row(row++) << pair.negative_m.transpose().array(), -pair.strength_uTm2;
  }
}

void SteelField::build(std::size_t first, std::size_t last) {
  const std::size_t own = nodes_.size();
  nodes_.emplace_back();
  if (last - first > kLeaf) {
    halve(pairs_, first, last);
    build(first, (first + last) / 2);
    build((first + last) / 2, last);
  }
  Node node;
  double weight = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    const double w = moment_uTm3(pairs_[i]).norm() + 1e-12;  // a pair without strength still has a place
    node.middle_m += w * middle_m(pairs_[i]);
    node.moment_uTm3 += moment_uTm3(pairs_[i]);
    weight += w;
  }
  node.middle_m /= weight;
  double radius_m = 0.0;
  for (std::size_t i = first; i < last; ++i)
    radius_m = std::max({radius_m, (pairs_[i].positive_m - node.middle_m).norm(),
                         (pairs_[i].negative_m - node.middle_m).norm()});
  node.near_m2 = std::pow(kOpening * radius_m, 2);
  node.first = static_cast<std::uint32_t>(first);
  node.last = static_cast<std::uint32_t>(last);
  node.next = static_cast<std::uint32_t>(nodes_.size());
  nodes_[own] = node;
}

Eigen::Vector3d SteelField::near_field_uT(const Node& node, const Eigen::Vector3d& position_m) const {
  constexpr Eigen::Index kMost = 2 * static_cast<Eigen::Index>(kLeaf);
  using Column = Eigen::Array<double, Eigen::Dynamic, 1, 0, kMost, 1>;
  const Eigen::Index first = 2 * static_cast<Eigen::Index>(node.first),
                     count = 2 * static_cast<Eigen::Index>(node.last) - first;
  const Column x = position_m.x() - charges_.col(0).segment(first, count),
               y = position_m.y() - charges_.col(1).segment(first, count),
               z = position_m.z() - charges_.col(2).segment(first, count);
  // Inside a charge's ball the distance that divides stays its radius: the field grows linearly there.
  const Column squared = (x.square() + y.square() + z.square()).max(kChargeRadius_m * kChargeRadius_m);
  const Column weight = charges_.col(3).segment(first, count) / (squared * squared.sqrt());
  return {(weight * x).sum(), (weight * y).sum(), (weight * z).sum()};
}

Eigen::Vector3d SteelField::field_uT(const Eigen::Vector3d& position_m) const {
  Eigen::Vector3d sum = background_uT_;
  for (std::size_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    const Eigen::Vector3d r = position_m - node.middle_m;
    const double squared = r.squaredNorm();
    if (squared >= node.near_m2 && squared > 0) {
      sum += dipole_field(node.moment_uTm3, r, squared);
    } else if (node.next == i + 1) {
      sum += near_field_uT(node, position_m);
    } else {
      ++i;  // look closer, at its two halves
      continue;
    }
    i = node.next;
  }
  return sum;
}

}  // namespace mstsl::sim
