#include "bilinear_lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "point_bins.hpp"

namespace mstsl {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The four nodes around a point and their bilinear weights.
struct Corner {
  long row, column;
  double weight;
};
std::array<Corner, 4> corners_around(const Vector2d& position_m, double spacing_m) {
  const Vector2d p = position_m / spacing_m;
  const double u = p.x() - std::floor(p.x()), v = p.y() - std::floor(p.y());
  const long column = std::lround(std::floor(p.x())), row = std::lround(std::floor(p.y()));
  return {{{row, column, (1 - u) * (1 - v)},
           {row, column + 1, u * (1 - v)},
           {row + 1, column, (1 - u) * v},
           {row + 1, column + 1, u * v}}};
}

}  // namespace

BilinearLattice::BilinearLattice(std::span<const Vector2d> positions_m,
                                 std::span<const Fingerprint> fingerprints, double spacing_m)
    : spacing_m_(spacing_m) {
  std::vector<Node> parts;
  for (std::size_t i = 0; i < positions_m.size(); ++i)
    for (const Corner& corner : corners_around(positions_m[i], spacing_m))
      if (corner.weight > 0.0)
        parts.push_back({corner.row, corner.column, corner.weight, corner.weight * fingerprints[i].field_uT});
  merge(std::move(parts));
  for (Node& node : nodes_) {
    node.sum_uT /= node.weight;
    node.weight = 1.0;
  }
  fill_border();
}

/// Adds up the parts of the same node.
void BilinearLattice::merge(std::vector<Node> parts) {
  std::stable_sort(parts.begin(), parts.end(), [](const Node& a, const Node& b) {
    return std::tie(a.row, a.column) < std::tie(b.row, b.column);
  });
  for (const Node& part : parts) {
    if (nodes_.empty() || nodes_.back().row != part.row || nodes_.back().column != part.column) {
      nodes_.push_back(part);
      continue;
    }
    nodes_.back().weight += part.weight;
    nodes_.back().sum_uT += part.sum_uT;
  }
}

void BilinearLattice::fill_border() {
  std::vector<Node> border;
  for (const Node& node : nodes_)
    for (long dr = -1; dr <= 1; ++dr)
      for (long dc = -1; dc <= 1; ++dc)
        if (find(node.row + dr, node.column + dc) == nullptr)
          border.push_back({node.row + dr, node.column + dc, 1.0, node.sum_uT});
  std::vector<Node> all = std::exchange(nodes_, {});
  all.insert(all.end(), border.begin(), border.end());
  merge(std::move(all));
  for (Node& node : nodes_) node.sum_uT /= node.weight;
}

const BilinearLattice::Node* BilinearLattice::find(long row, long column) const {
  const auto it = std::lower_bound(
      nodes_.begin(), nodes_.end(), std::pair(row, column),
      [](const Node& node, const auto& key) { return std::pair(node.row, node.column) < key; });
  return it != nodes_.end() && it->row == row && it->column == column ? &*it : nullptr;
}

std::optional<Vector3d> BilinearLattice::at(const Vector2d& position_m) const {
  Vector3d sum = Vector3d::Zero();
  for (const Corner& corner : corners_around(position_m, spacing_m_)) {
    const Node* node = find(corner.row, corner.column);
    if (node == nullptr) return std::nullopt;
    sum += corner.weight * node->sum_uT;
  }
  return sum;
}

double lane_spacing_m(std::span<const Fingerprint> fingerprints) {
  constexpr double kSameLine_m = 0.15, kFarthest_m = 2.0, kAbreast_m = 0.1, kDefault_m = 0.5;
  std::vector<Vector2d> points;
  for (const Fingerprint& f : fingerprints) points.push_back(f.position_m);
  const PointBins bins(points, 0.5);
  std::vector<double> spacings;
  const std::size_t stride = 1 + points.size() / 2000;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Vector2d along(std::cos(fingerprints[i].heading_rad), std::sin(fingerprints[i].heading_rad));
    double nearest_m = kFarthest_m;
    bins.for_each_near(points[i].array() - kFarthest_m, points[i].array() + kFarthest_m, [&](std::size_t j) {
      const Vector2d offset = points[j] - points[i];
      const double side_m = std::abs(along.x() * offset.y() - along.y() * offset.x());
      if (side_m > kSameLine_m && std::abs(along.dot(offset)) < kAbreast_m)
        nearest_m = std::min(nearest_m, side_m);
    });
    if (nearest_m < kFarthest_m) spacings.push_back(nearest_m);
  }
  if (spacings.empty()) return kDefault_m;
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  return *middle;
}

}  // namespace mstsl
